#pragma once
#include <cstdint>
#include <vector>

#include "geom/vec.h"

namespace wale {

/// One yarn of a tile: a closed polyline on the torus. Point i is joined to point i + 1, the last one to the first one
/// `shift` periods further on.
struct PeriodicYarn {
  uint32_t first = 0, count = 0;  ///< its points
  ivec2 shift{1, 0};
  double length = 0;  ///< rest length of one lap, metres
};

/// Centrelines of the yarns of a tile that is periodic in x and y.
struct PeriodicYarns {
  std::vector<dvec3> points;  ///< metres
  std::vector<PeriodicYarn> yarns;
  dvec2 period{0, 0};
  double radius = 0;
};

/// A segment of them: from point a to point b, which lies `shift` periods further on.
struct YarnSegment {
  uint32_t a = 0, b = 0, yarn = 0;
  ivec2 shift{0, 0};
  double length = 0;  ///< at rest
  double arc = 0;     ///< rest length of the yarn up to a
};
std::vector<YarnSegment> segments_of(const PeriodicYarns& yarns);

/// Two segments that may touch, the second one `image` periods from where its points lie.
struct SegmentPair {
  uint32_t first = 0, second = 0;
  ivec2 image{0, 0};
};

/// Where two segments are closest: p + s (q - p) of the first, with weights of the points, and the way between them.
struct Closest {
  double s = 0, t = 0;
  dvec3 way{0, 0, 0};  ///< from the second to the first
};
Closest closest_points(const dvec3& p0, const dvec3& p1, const dvec3& q0, const dvec3& q1);

/// All pairs of segments of which some points are nearer than `reach`, but for those of one yarn less than `apart` of
/// arc from each other: those are neighbours. Each pair once, in a fixed order.
std::vector<SegmentPair> near_pairs(const PeriodicYarns& yarns, const std::vector<YarnSegment>& segments, double reach,
                                    double apart);

}  // namespace wale
