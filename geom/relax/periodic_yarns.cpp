#include "geom/relax/periodic_yarns.h"

#include <algorithm>
#include <cmath>

namespace wale {
namespace {

dvec3 shifted(const dvec3& p, const dvec2& period, ivec2 by) {
  return p + dvec3(period.x * by.x, period.y * by.y, 0.0);
}

int wrap(int i, int n) { return ((i % n) + n) % n; }

}  // namespace

std::vector<YarnSegment> segments_of(const PeriodicYarns& yarns) {
  std::vector<YarnSegment> out;
  for (size_t y = 0; y < yarns.yarns.size(); ++y) {
    const PeriodicYarn& yarn = yarns.yarns[y];
    const double step = yarn.length / yarn.count;
    for (uint32_t i = 0; i < yarn.count; ++i) {
      const bool last = i + 1 == yarn.count;
      out.push_back({yarn.first + i, last ? yarn.first : yarn.first + i + 1, uint32_t(y),
                     last ? yarn.shift : ivec2(0, 0), step, step * i});
    }
  }
  return out;
}

// Ericson 2005, section 5.1.9, with the clamped ends tried in turn; segments have some length.
Closest closest_points(const dvec3& p0, const dvec3& p1, const dvec3& q0, const dvec3& q1) {
  const dvec3 d1 = p1 - p0, d2 = q1 - q0, r = p0 - q0;
  const double a = glm::dot(d1, d1), e = glm::dot(d2, d2), f = glm::dot(d2, r), c = glm::dot(d1, r),
               b = glm::dot(d1, d2), denominator = a * e - b * b;
  Closest out;
  out.s = denominator > 1e-12 * a * e ? std::clamp((b * f - c * e) / denominator, 0.0, 1.0) : 0.5;
  out.t = (b * out.s + f) / e;
  if (out.t < 0 || out.t > 1) {
    out.t = std::clamp(out.t, 0.0, 1.0);
    out.s = std::clamp((b * out.t - c) / a, 0.0, 1.0);
  } else if (!(denominator > 1e-12 * a * e)) {
    out.s = std::clamp((b * out.t - c) / a, 0.0, 1.0);
  }
  out.way = (p0 + out.s * d1) - (q0 + out.t * d2);
  return out;
}

std::vector<SegmentPair> near_pairs(const PeriodicYarns& yarns, const std::vector<YarnSegment>& segments, double reach,
                                    double apart) {
  // Segments stand in cells of the torus by their middles, at least as wide as two of them may lie apart.
  double longest = 0;
  std::vector<dvec3> middle(segments.size());
  std::vector<ivec2> home(segments.size());  // periods to add to bring the middle into the tile
  for (size_t i = 0; i < segments.size(); ++i) {
    const dvec3 a = yarns.points[segments[i].a],
                b = shifted(yarns.points[segments[i].b], yarns.period, segments[i].shift);
    longest = std::max(longest, glm::length(b - a));
    middle[i] = 0.5 * (a + b);
    home[i] = {-int(std::floor(middle[i].x / yarns.period.x)), -int(std::floor(middle[i].y / yarns.period.y))};
    middle[i] = shifted(middle[i], yarns.period, home[i]);
  }
  const double far = reach + longest;
  const int nx = std::max(1, int(yarns.period.x / far)), ny = std::max(1, int(yarns.period.y / far));
  const int rx = nx >= 3 ? 1 : int(std::ceil(far / (yarns.period.x / nx))),
            ry = ny >= 3 ? 1 : int(std::ceil(far / (yarns.period.y / ny)));
  std::vector<std::vector<uint32_t>> cells(size_t(nx) * size_t(ny));
  const auto column = [&](double x) { return std::min(nx - 1, int(x / yarns.period.x * nx)); };
  const auto row = [&](double y) { return std::min(ny - 1, int(y / yarns.period.y * ny)); };
  for (size_t i = 0; i < segments.size(); ++i)
    cells[size_t(row(middle[i].y) * nx + column(middle[i].x))].push_back(uint32_t(i));
  std::vector<SegmentPair> out;
  for (size_t i = 0; i < segments.size(); ++i) {
    const int cx = column(middle[i].x), cy = row(middle[i].y);
    for (int y = cy - ry; y <= cy + ry; ++y)
      for (int x = cx - rx; x <= cx + rx; ++x) {
        const int wx = wrap(x, nx), wy = wrap(y, ny);
        const ivec2 turn((x - wx) / nx, (y - wy) / ny);
        for (const uint32_t j : cells[size_t(wy * nx + wx)]) {
          // Each pair once: of a pair and its mirror image, that with the smaller first number or the larger image.
          const ivec2 image = turn + home[j] - home[i];
          if (j < i || (j == i && (image.x < 0 || (image.x == 0 && image.y <= 0)))) continue;
          if (glm::length(middle[i] - shifted(middle[j], yarns.period, turn)) > far) continue;
          const YarnSegment &f = segments[i], &g = segments[j];
          if (f.yarn == g.yarn) {
            // Arc between them, if the image lies a whole number of laps further along this very yarn.
            const PeriodicYarn& yarn = yarns.yarns[f.yarn];
            const int laps = yarn.shift.x ? image.x / yarn.shift.x : yarn.shift.y ? image.y / yarn.shift.y : 0;
            if (ivec2(laps * yarn.shift.x, laps * yarn.shift.y) == image &&
                std::abs(g.arc + laps * yarn.length - f.arc) < apart)
              continue;
          }
          const dvec3 p0 = yarns.points[f.a], p1 = shifted(yarns.points[f.b], yarns.period, f.shift);
          const dvec3 q0 = shifted(yarns.points[g.a], yarns.period, image),
                      q1 = shifted(yarns.points[g.b], yarns.period, image + g.shift);
          if (glm::length(closest_points(p0, p1, q0, q1).way) < reach) out.push_back({uint32_t(i), j, image});
        }
      }
  }
  return out;
}

}  // namespace wale
