#pragma once
#include <fmt/format.h>

#include <compare>
#include <optional>
#include <string>
#include <string_view>

namespace wale {

constexpr int kMostNeedles = 10000;

/// A needle of a V-bed machine. Order along the beds: number, front before back.
struct Needle {
  int number = 0;
  bool back = false;
  auto operator<=>(const Needle&) const = default;
};

/// "f12", "b-3"; nothing where that is no needle.
inline std::optional<Needle> needle_of(std::string_view word) {
  if (word.size() < 2 || (word[0] != 'f' && word[0] != 'b')) return std::nullopt;
  const bool negative = word[1] == '-';
  int value = 0;
  for (const char c : word.substr(negative ? 2 : 1)) {
    if (c < '0' || c > '9' || value > kMostNeedles) return std::nullopt;
    value = 10 * value + (c - '0');
  }
  if (word.size() == 2 && negative) return std::nullopt;
  return Needle{negative ? -value : value, word[0] == 'b'};
}

inline std::string needle_text(Needle n) { return fmt::format("{}{}", n.back ? 'b' : 'f', n.number); }

}  // namespace wale
