#include "geom/strain_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace wale {
namespace {

/// The interval of an axis that holds a value, and where in it the value lies, 0 to 1.
struct AxisPlace {
  size_t low = 0, high = 0;
  double share = 0;
  bool clamped = false;
};

AxisPlace place_on(const std::vector<double>& axis, double value) {
  const size_t high = size_t(std::upper_bound(axis.begin(), axis.end(), value) - axis.begin());
  if (high == 0) return {0, 0, 0, value < axis.front()};
  if (high == axis.size()) return {high - 1, high - 1, 0, value > axis.back()};
  const double low = axis[high - 1];
  return {high - 1, high, (value - low) / (axis[high] - low), false};
}

std::string fault_of_axis(const char* name, const std::vector<double>& axis) {
  for (size_t i = 0; i < axis.size(); ++i) {
    if (!std::isfinite(axis[i])) return fmt::format("{}[{}]: the strain is not finite", name, i);
    if (!(axis[i] > -1))
      return fmt::format("{}[{}]: a strain of {} leaves no cloth; give more than -1", name, i, axis[i]);
    if (i > 0 && !(axis[i] > axis[i - 1]))
      return fmt::format("{}[{}]: {} after {}; strains must ascend", name, i, axis[i], axis[i - 1]);
  }
  if (std::find(axis.begin(), axis.end(), 0.0) == axis.end())
    return fmt::format("{}: 0 is not among the strains; the tile itself must be", name);
  return {};
}

}  // namespace

StrainWeights strain_weights(const StrainTable& table, dvec2 strain) {
  const AxisPlace c = place_on(table.course, strain.x), w = place_on(table.wale, strain.y);
  const size_t row = table.course.size();
  return {{w.low * row + c.low, w.low * row + c.high, w.high * row + c.low, w.high * row + c.high},
          {(1 - w.share) * (1 - c.share), (1 - w.share) * c.share, w.share * (1 - c.share), w.share * c.share},
          c.clamped || w.clamped};
}

std::string fault_of(const StrainTable& table, size_t points) {
  if (table.course.empty() && table.wale.empty() && table.offsets.empty()) return {};
  if (std::string fault = fault_of_axis("course", table.course); !fault.empty()) return fault;
  if (std::string fault = fault_of_axis("wale", table.wale); !fault.empty()) return fault;
  if (const size_t shapes = table.course.size() * table.wale.size(); table.offsets.size() != shapes)
    return fmt::format("offsets: {} shapes for {} x {} strains; give {}, those of one wale strain after another",
                       table.offsets.size(), table.course.size(), table.wale.size(), shapes);
  for (size_t i = 0; i < table.offsets.size(); ++i) {
    const auto& shape = table.offsets[i];
    if (shape.size() != points)
      return fmt::format("offsets[{}]: {} points; the tile's curves have {}", i, shape.size(), points);
    for (size_t p = 0; p < points; ++p)
      if (!std::isfinite(shape[p].x) || !std::isfinite(shape[p].y) || !std::isfinite(shape[p].z))
        return fmt::format("offsets[{}][{}]: the offset is not finite", i, p);
  }
  return {};
}

}  // namespace wale
