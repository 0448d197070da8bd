#include "geom/relax/resolution.h"

#include <algorithm>

#include "geom/relax/step_bound.h"
#include "geom/relax/yarn_terms.h"

namespace wale {

PeriodicYarns refined(const PeriodicYarns& yarns) {
  PeriodicYarns out = yarns;
  out.points.clear();
  for (const YarnSegment& s : segments_of(yarns)) {
    out.points.push_back(yarns.points[s.a]);
    out.points.push_back(yarns.points[s.a] + 0.5 * edge_of(yarns, s));
  }
  for (PeriodicYarn& yarn : out.yarns) yarn.first *= 2, yarn.count *= 2;
  return out;
}

std::optional<PeriodicYarns> coarsened(const PeriodicYarns& yarns, double neighbours,
                                       const std::function<bool(const PeriodicYarns&)>& over) {
  constexpr int kSteps = 40;
  constexpr double kReach = 1.0, kKept = 0.5;
  for (const PeriodicYarn& yarn : yarns.yarns)
    if (yarn.count % 2 || yarn.count < 16) return std::nullopt;
  const auto closest = [&](const PeriodicYarns& y) {
    const std::vector<YarnSegment> all = segments_of(y);
    double least = kReach;
    for (const SegmentPair& pair : near_pairs(y, all, kReach, neighbours))
      least = std::min(least, glm::length(closest_of(y, all, pair).way));
    return least;
  };
  PeriodicYarns work = yarns;
  const std::vector<YarnSegment> segments = segments_of(yarns);
  TileStep step;
  step.points.assign(yarns.points.size(), dvec3(0.0));
  for (int i = 0; i < kSteps && !(over && over(work)); ++i) {
    for (size_t k = 1; k < segments.size(); k += 2)
      step.points[segments[k].a] = 0.5 * (edge_of(work, segments[k]) - edge_of(work, segments[k - 1]));
    const double share = safe_share(work, segments, near_pairs(work, segments, kReach, neighbours), kReach, 0, step);
    work = moved(work, step, share);
    if (share < 1) continue;
    if (over && over(work)) break;
    PeriodicYarns out = work;
    out.points.clear();
    for (size_t k = 0; k < work.points.size(); k += 2) out.points.push_back(work.points[k]);
    for (PeriodicYarn& yarn : out.yarns) yarn.first /= 2, yarn.count /= 2;
    // Yarns that nearly touch there would have to start very thin.
    if (closest(out) < kKept * closest(yarns)) return std::nullopt;
    return out;
  }
  return std::nullopt;
}

}  // namespace wale
