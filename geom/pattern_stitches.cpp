#include <algorithm>

#include "geom/error.h"
#include "geom/pattern_readers.h"
#include "geom/stitch.h"

namespace wale {
namespace {

/// Highs of y along one cycle that stand out by more than `step` on both sides: a maximum counts once y has fallen
/// `step` below it, and the next one can begin once y has risen `step` above the low between them.
int loop_heads(const std::vector<double>& y, double step) {
  const size_t count = y.size();
  const size_t lowest = std::min_element(y.begin(), y.end()) - y.begin();
  int heads = 0;
  bool rising = true;
  double extreme = y[lowest];
  double low = y[lowest];
  for (size_t i = 1; i <= count; ++i) {
    const double value = y[(lowest + i) % count];
    if (rising) {
      extreme = std::max(extreme, value);
      if (extreme - low > step && extreme - value > step) {
        ++heads;
        rising = false;
        low = value;
      }
    } else {
      low = std::min(low, value);
      if (value - low > step) {
        rising = true;
        extreme = value;
      }
    }
  }
  return heads;
}

}  // namespace

ivec2 estimate_stitches(const Pattern& pattern) {
  const std::vector<YarnChain> yarns = tile_yarns(pattern, match_partners(pattern));
  int courses = 0, across = 0;
  for (const YarnChain& yarn : yarns) {
    courses += std::abs(yarn.shift.x);
    if (yarn.shift.x == 0) across += std::abs(yarn.shift.y);
  }
  courses = std::max(1, courses);
  double wales = 0;
  for (const YarnChain& yarn : yarns) {
    if (yarn.shift.x == 0 || yarn.shift.y != 0) continue;
    std::vector<double> y;
    for (const Link& link : yarn.links) {
      const auto& points = pattern.curves[link.curve].points;
      for (size_t i = 0; i + 1 < points.size(); ++i)
        y.push_back(points[link.reversed ? points.size() - 1 - i : i].y + link.instance.y * pattern.period.y);
    }
    // Loops overlap the next course, so they are higher than one; half a course sets them apart from a wobble.
    const int heads = loop_heads(y, pattern.period.y / courses / 2);
    wales = std::max(wales, double(heads) / std::abs(yarn.shift.x));
  }
  return {std::max({1, static_cast<int>(wales + 0.5), across}), courses};
}

}  // namespace wale
