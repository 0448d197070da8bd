#include "geom/mesh_text_check.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

#include "geom/error.h"
#include "geom/word_lines.h"

namespace wale {
namespace {

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

PlyProperty ply_property(WordLines& lines, const std::string& file) {
  const std::string_view first = lines.word();
  if (first != "list") {
    const PlyType& type = ply_type(first, file);
    return {type.bytes, 0, false, type.whole, type.sign};
  }
  const PlyType &count = ply_type(lines.word(), file), &item = ply_type(lines.word(), file);
  if (!count.whole) user_error("{}: the length of a list is a '{}'; a whole number is needed", file, count.name);
  return {item.bytes, count.bytes, count.sign, item.whole, item.sign};
}

PlyHeader ply_header(WordLines& lines, const std::string& file) {
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

void require_whole_text(WordLines& lines, const PlyHeader& header) {
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
  WordLines lines(text, file);
  const PlyHeader header = ply_header(lines, file);
  if (header.body == PlyHeader::Body::text)
    require_whole_text(lines, header);
  else
    require_whole_binary(lines.remaining(), header, file);
}

}  // namespace wale
