#pragma once
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "geom/error.h"

namespace wale {

/// The lines of a file, cut into words one after the other.
class WordLines {
 public:
  WordLines(std::string_view text, const std::string& file) : text_(text), file_(file) {}

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
  /// Whether the line has more words.
  bool more() const { return line_.find_first_not_of(kBlank) != std::string_view::npos; }
  /// The line's number in the file, from 1.
  size_t number() const { return number_; }
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
  std::vector<double> numbers(size_t count, const char* what) {
    std::vector<double> values;
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
      values.push_back(too_small ? 0 : value);
    }
    return values;
  }
  /// Whole numbers from `low` to `high`.
  std::vector<int64_t> whole_numbers(size_t count, int64_t low, int64_t high, const char* what) {
    std::vector<int64_t> values;
    for (size_t i = 0; i < count; ++i) {
      const std::string_view text = word();
      if (text.empty())
        user_error("{}:{}: {} of {} numbers has only {}; the file is not whole", file_, number_, what, count, i);
      int64_t value = 0;
      const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
      if (error != std::errc{} || rest != text.data() + text.size() || value < low || value > high)
        user_error("{}:{}: '{}' is not a whole number from {} to {}", file_, number_, text.substr(0, 20), low, high);
      values.push_back(value);
    }
    return values;
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

}  // namespace wale
