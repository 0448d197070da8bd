#include "geom/mesh_text_check.h"

#include <charconv>
#include <cmath>
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
  void numbers(size_t count, const char* what) {
    for (size_t i = 0; i < count; ++i) {
      std::string_view text = word();
      if (text.empty())
        user_error("{}:{}: {} of {} numbers has only {}; the file is not whole", file_, number_, what, count, i);
      const std::string_view shown = text.substr(0, 20);
      if (text.front() == '+') text.remove_prefix(1);
      double value = 0;
      const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
      const bool too_small = error == std::errc::result_out_of_range && text.find("e-") != std::string_view::npos;
      if ((error != std::errc{} && !too_small && error != std::errc::result_out_of_range) ||
          rest != text.data() + text.size())
        user_error("{}:{}: {}: '{}' is not a number", file_, number_, what, shown);
      // OpenMesh reads floats, and from the first one that it cannot hold it reads zeros.
      if (!too_small && (error != std::errc{} || !(std::abs(value) <= std::numeric_limits<float>::max())))
        user_error("{}:{}: {}: '{}' is not a finite number of single precision", file_, number_, what, shown);
    }
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

struct Element {
  std::string name;
  size_t count;
  std::vector<bool> is_list;  ///< per property
};

}  // namespace

void require_whole_ply(const std::string& text, const std::string& file) {
  Lines lines(text, file);
  std::vector<Element> elements;
  for (bool header = true; header;) {
    if (!lines.next()) user_error("{}: not a mesh that can be read: a PLY without end_header", file);
    const std::string_view key = lines.word();
    if (key == "format" && lines.word() != "ascii") return;
    if (key == "element") {
      const std::string name(lines.word());
      elements.push_back({name, lines.count("elements"), {}});
    }
    if (key == "property" && !elements.empty()) elements.back().is_list.push_back(lines.word() == "list");
    header = key != "end_header";
  }
  for (const Element& element : elements)
    for (size_t i = 0; i < element.count; ++i) {
      lines.element(element.name.c_str(), i, element.count);
      for (const bool list : element.is_list) lines.numbers(list ? lines.count("list items") : 1, element.name.c_str());
    }
}

void require_whole_off(const std::string& text, const std::string& file) {
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
  for (size_t i = 0; i < vertices; ++i) {
    lines.element("vertex", i, vertices, '#');
    lines.numbers(3, "a vertex");
  }
  for (size_t i = 0; i < faces; ++i) {
    lines.element("face", i, faces, '#');
    lines.numbers(lines.count("corners"), "a face");
  }
}

}  // namespace wale
