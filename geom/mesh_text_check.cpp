#include "geom/mesh_text_check.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

#include "geom/error.h"

namespace wale {
namespace {

/// The lines of a file, cut into words one after the other.
class Lines {
 public:
  Lines(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  /// Goes to the next line that is neither blank nor, from `comment` on, only a comment; false at the end of the file.
  bool next(char comment = '\0') {
    while (at_ < text_.size()) {
      const size_t end = std::min(text_.find('\n', at_), text_.size());
      line_ = text_.substr(at_, end - at_);
      at_ = end + 1;
      ++number_;
      if (comment) line_ = line_.substr(0, line_.find(comment));
      if (line_.find_first_not_of(kBlank) != std::string_view::npos) return true;
    }
    return false;
  }
  /// The next word of the line, empty when it has no more.
  std::string_view word() {
    const size_t from = line_.find_first_not_of(kBlank);
    if (from == std::string_view::npos) return {};
    const size_t to = std::min(line_.find_first_of(kBlank, from), line_.size());
    const std::string_view result = line_.substr(from, to - from);
    line_.remove_prefix(to);
    return result;
  }
  /// What follows the line.
  std::string_view remaining() const { return text_.substr(std::min(at_, text_.size())); }
  /// What is left of the line.
  std::string_view rest() const { return line_; }
  size_t count(const char* what) {
    const std::string_view text = word();
    size_t value = 0;
    const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || rest != text.data() + text.size())
      user_error("{}:{}: a number of {} is needed, not '{}'", file_, number_, what, text.substr(0, 20));
    return value;
  }
  /// Numbers that a float holds: a stream that meets any other stops there, and gives its last number for ever after.
  void numbers(size_t count, const char* what) {
    for (size_t i = 0; i < count; ++i) {
      std::string_view text = word();
      if (text.empty())
        user_error("{}:{}: {} of {} numbers has only {}; the file is not whole", file_, number_, what, count, i);
      const std::string_view shown = text.substr(0, 20);
      if (text.front() == '+') text.remove_prefix(1);
      double value = 0;
      const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
      // What is too small even for a double counts as 0, as it does for a stream.
      const bool too_small =
          error == std::errc::result_out_of_range && (text.find("e-") != text.npos || text.find("E-") != text.npos);
      if ((error != std::errc{} && !too_small) || rest != text.data() + text.size() ||
          !(std::abs(value) <= std::numeric_limits<float>::max()))
        user_error("{}:{}: {}: '{}' is not a number that a float holds", file_, number_, what, shown);
    }
  }
  /// Whole numbers from `low` to `high`.
  void whole_numbers(size_t count, int64_t low, int64_t high, const char* what) {
    for (size_t i = 0; i < count; ++i) {
      const std::string_view text = word();
      if (text.empty())
        user_error("{}:{}: {} of {} numbers has only {}; the file is not whole", file_, number_, what, count, i);
      int64_t value = 0;
      const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
      if (error != std::errc{} || rest != text.data() + text.size() || value < low || value > high)
        user_error("{}:{}: '{}' is not a whole number from {} to {}", file_, number_, text.substr(0, 20), low, high);
    }
  }
  /// Refuses more words: readers that take words one after the other would take them for the next element's.
  void end(const char* what) {
    if (const std::string_view more = word(); !more.empty())
      user_error("{}:{}: '{}' is one word too many in this {} line", file_, number_, more.substr(0, 20), what);
  }
  void element(const char* what, size_t i, size_t count, char comment = '\0') {
    if (!next(comment))
      user_error("{}:{}: the file ends before {} {} of the {} that its header promises", file_, number_, what, i + 1,
                 count);
  }

 private:
  static constexpr const char* kBlank = " \t\r\v\f";
  std::string_view text_, line_;
  const std::string& file_;
  size_t at_ = 0, number_ = 0;
};

struct PlyProperty {
  size_t bytes = 0;         ///< of the value, or of one item of the list
  size_t count_bytes = 0;   ///< of a list's length, 0 = no list
  bool count_sign = false;  ///< of a list's length
  bool whole = false;       ///< of the value, or the items
  bool sign = false;
};

struct PlyElement {
  std::string name;
  size_t count;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  enum class Body { text, little_endian, big_endian } body = Body::text;
  std::vector<PlyElement> elements;
};

struct PlyType {
  std::string_view name, other_name;
  size_t bytes;
  bool whole, sign;
};
constexpr PlyType kPlyTypes[] = {{"char", "int8", 1, true, true},      {"uchar", "uint8", 1, true, false},
                                 {"short", "int16", 2, true, true},    {"ushort", "uint16", 2, true, false},
                                 {"int", "int32", 4, true, true},      {"uint", "uint32", 4, true, false},
                                 {"float", "float32", 4, false, true}, {"double", "float64", 8, false, true}};

const PlyType& ply_type(std::string_view name, const std::string& file) {
  for (const PlyType& type : kPlyTypes)
    if (name == type.name || name == type.other_name) return type;
  user_error("{}: '{}' is no type of a PLY; they are char, uchar, short, ushort, int, uint, float, double", file,
             name.substr(0, 20));
}

PlyProperty ply_property(Lines& lines, const std::string& file) {
  const std::string_view first = lines.word();
  if (first != "list") {
    const PlyType& type = ply_type(first, file);
    return {type.bytes, 0, false, type.whole, type.sign};
  }
  const PlyType &count = ply_type(lines.word(), file), &item = ply_type(lines.word(), file);
  if (!count.whole) user_error("{}: the length of a list is a '{}'; a whole number is needed", file, count.name);
  return {item.bytes, count.bytes, count.sign, item.whole, item.sign};
}

PlyHeader ply_header(Lines& lines, const std::string& file) {
  PlyHeader header;
  if (!lines.next() || lines.word() != "ply") user_error("{}: not a mesh that can be read: does not begin 'ply'", file);
  while (true) {
    if (!lines.next()) user_error("{}: not a mesh that can be read: a PLY without end_header", file);
    const std::string_view key = lines.word();
    if (key == "end_header") return header;
    if (key == "format") {
      const std::string_view body = lines.word();
      if (body == "binary_little_endian") header.body = PlyHeader::Body::little_endian;
      if (body == "binary_big_endian") header.body = PlyHeader::Body::big_endian;
      if ((body != "ascii" && header.body == PlyHeader::Body::text) || lines.word() != "1.0")
        user_error("{}: not a PLY format; it is ascii, binary_little_endian or binary_big_endian, version 1.0", file);
      lines.end("format");
    } else if (key == "element") {
      const std::string name(lines.word());
      header.elements.push_back({name, lines.count("elements"), {}});
      lines.end("element");
    } else if (key == "property" && !header.elements.empty()) {
      header.elements.back().properties.push_back(ply_property(lines, file));
      lines.word();  // its name
      lines.end("property");
    } else if (key != "comment" && key != "obj_info") {
      user_error("{}: '{}' does not belong into the header of a PLY", file, key.substr(0, 20));
    }
  }
}

void require_whole_text(Lines& lines, const PlyHeader& header) {
  for (const PlyElement& element : header.elements)
    for (size_t i = 0; i < element.count; ++i) {
      lines.element(element.name.c_str(), i, element.count);
      for (const PlyProperty& property : element.properties) {
        const size_t count = property.count_bytes ? lines.count("list items") : 1;
        const int bits = static_cast<int>(8 * property.bytes);
        if (property.whole)
          lines.whole_numbers(count, property.sign ? -(int64_t(1) << (bits - 1)) : 0,
                              (int64_t(1) << (property.sign ? bits - 1 : bits)) - 1, element.name.c_str());
        else
          lines.numbers(count, element.name.c_str());
      }
      lines.end(element.name.c_str());
    }
}

/// A list's length; the largest number where it is negative, which no file has bytes for.
uint64_t list_length(std::string_view bytes, const PlyProperty& property, bool big_endian) {
  uint64_t value = 0;
  for (size_t i = 0; i < property.count_bytes; ++i) {
    const size_t at = big_endian ? i : property.count_bytes - 1 - i;
    value = value << 8 | static_cast<unsigned char>(bytes[at]);
  }
  return property.count_sign && value >> (8 * property.count_bytes - 1) ? UINT64_MAX : value;
}

void require_whole_binary(std::string_view body, const PlyHeader& header, const std::string& file) {
  const auto take = [&](const PlyElement& element, size_t i, uint64_t items, size_t bytes) {
    if (items > body.size() / bytes)
      user_error("{}: the file ends before {} {} of the {} that its header promises", file, element.name, i + 1,
                 element.count);
    body.remove_prefix(static_cast<size_t>(items) * bytes);
  };
  for (const PlyElement& element : header.elements) {
    if (element.count > 0 && element.properties.empty())
      user_error("{}: {} {} elements without a property", file, element.count, element.name);
    for (size_t i = 0; i < element.count; ++i)
      for (const PlyProperty& property : element.properties) {
        uint64_t items = 1;
        if (property.count_bytes) {
          const std::string_view start = body;
          take(element, i, 1, property.count_bytes);
          items = list_length(start, property, header.body == PlyHeader::Body::big_endian);
        }
        take(element, i, items, property.bytes);
      }
  }
}

}  // namespace

void require_whole_ply(std::string_view text, const std::string& file) {
  Lines lines(text, file);
  const PlyHeader header = ply_header(lines, file);
  if (header.body == PlyHeader::Body::text)
    require_whole_text(lines, header);
  else
    require_whole_binary(lines.remaining(), header, file);
}

void require_whole_off(std::string_view text, const std::string& file) {
  Lines lines(text, file);
  if (!lines.next('#')) user_error("{}: not a mesh that can be read: the file is empty", file);
  const std::string_view magic = lines.word();
  if (!magic.ends_with("OFF"))
    user_error("{}: not a mesh that can be read; give a complete OBJ, PLY or OFF file", file);
  if (lines.rest().find("BINARY") != std::string_view::npos)
    user_error("{}: a binary OFF is not read; save it as text, or as PLY", file);
  if (lines.rest().find_first_of("0123456789") != std::string_view::npos)
    user_error("{}: not a mesh that can be read: put the counts on a line of their own, below the word OFF", file);
  lines.element("line", 0, 1, '#');
  const size_t vertices = lines.count("vertices"), faces = lines.count("faces");
  lines.count("edges");  // not used, but OpenMesh takes the next word for it
  lines.end("count");
  const bool colors = magic.substr(0, magic.size() - 3).find('C') != std::string_view::npos;
  // [ST][C][N][4][n]OFF: each vertex has these numbers in a row, and colours at the end.
  const size_t per_vertex = 3 + (magic.find("ST") != std::string_view::npos ? 2 : 0) +
                            (magic.substr(0, magic.size() - 3).find('N') != std::string_view::npos ? 3 : 0);
  for (size_t i = 0; i < vertices; ++i) {
    lines.element("vertex", i, vertices, '#');
    lines.numbers(per_vertex, "a vertex");
    if (!colors) lines.end("vertex");
  }
  for (size_t i = 0; i < faces; ++i) {
    lines.element("face", i, faces, '#');
    lines.whole_numbers(lines.count("corners"), 0, std::numeric_limits<int32_t>::max(), "a face");
  }
}

}  // namespace wale
