#include "geom/numbered_name.h"

#include <charconv>

#include "geom/error.h"

namespace wale {
namespace {
constexpr size_t kMostDigits = 9;
}

NumberedName::NumberedName(const std::filesystem::path& pattern) : folder_(pattern.parent_path()) {
  const std::string name = pattern.filename().string();
  const size_t begin = name.find('#');
  if (begin == std::string::npos)
    user_error("{}: names no frames; write # for each digit of the number, for example cloth_####.obj",
               pattern.string());
  const size_t end = std::min(name.find_first_not_of('#', begin), name.size());
  if (is_one(folder_) || name.find('#', end) != std::string::npos)
    user_error("{}: # stands in several places; the number can stand in one only", pattern.string());
  before_ = name.substr(0, begin);
  after_ = name.substr(end);
  digits_ = end - begin;
  if (digits_ > kMostDigits) user_error("{}: numbers of {} digits; at most {}", pattern.string(), digits_, kMostDigits);
}

std::filesystem::path NumberedName::file(long number) const {
  return folder_ / fmt::format("{}{:0{}}{}", before_, number, digits_, after_);
}

std::optional<long> NumberedName::number(const std::string& name) const {
  if (name.size() < before_.size() + digits_ + after_.size() || !name.starts_with(before_) || !name.ends_with(after_))
    return {};
  const size_t length = name.size() - before_.size() - after_.size();
  const std::string_view digits = std::string_view(name).substr(before_.size(), length);
  if (length > kMostDigits || (length > digits_ && digits[0] == '0')) return {};
  long value = 0;
  const auto [stop, failed] = std::from_chars(digits.data(), digits.data() + length, value);
  if (failed != std::errc() || stop != digits.data() + length || digits[0] == '-') return {};
  return value;
}

}  // namespace wale
