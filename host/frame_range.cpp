#include "host/frame_range.h"

#include <charconv>
#include <string_view>

#include "geom/error.h"

namespace wale {

std::vector<long> frame_range(const std::string& text) {
  constexpr long kFarthest = 1'000'000;
  const auto number = [&](std::string_view word) {
    long value = 0;
    const auto [stop, failed] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (failed != std::errc() || stop != word.data() + word.size() || std::abs(value) > kFarthest)
      user_error("--frames {}: valid: 7, 0..47 or 0..47:2, of frames {} to {}", text, -kFarthest, kFarthest);
    return value;
  };
  const std::string_view all = text;
  const size_t dots = all.find("..");
  if (dots == std::string_view::npos) return {number(all)};
  const std::string_view rest = all.substr(dots + 2);
  const size_t colon = rest.find(':');
  const long first = number(all.substr(0, dots)), last = number(rest.substr(0, colon));
  const long step = colon == std::string_view::npos ? 1 : number(rest.substr(colon + 1));
  if (step < 1) user_error("--frames {}: a step of {}; valid: 1 or more", text, step);
  if (last < first) user_error("--frames {}: {} comes before {}; write the first frame first", text, last, first);
  std::vector<long> frames;
  for (long n = first; n <= last; n += step) frames.push_back(n);
  return frames;
}

}  // namespace wale
