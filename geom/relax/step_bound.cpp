// Why no yarn passes through another. On a step every point of the plane cover goes straight: x + share (E x + u), E =
// diag(ex, ey, 0), u the same in all tiles. Points between two ends of a segment go straight too, at speeds between
// those of the ends. So of two segments at distance d, if no end of the one moves by more than m (at share 1) against
// an end of the other, no two of their points do (the relative motion is bilinear in the two parameters, so its length
// is greatest at ends), and at share s they keep d - s m. Cut to s <= 0.9 d / m they keep a tenth of d.
//
// Pairs not in the list are `reach` R or more apart. For two of their points, w apart, |w| >= R, the way between them
// becomes w + s (E w + u1 - u2), not shorter than |w| (1 - s a) - 2 s r with a = max(|ex|, |ey|), r = max |u|. At
// s <= (R - keep) / (a R + 2 r) is s a < 1, so that is least at |w| = R: R - s (a R + 2 r) >= keep.
//
// Segments that are neighbours along a yarn are left out, as they touch always; they could only tie a knot of the size
// of the arc that counts as neighbours into it, which its bending stiffness forbids.
#include "geom/relax/step_bound.h"

#include <algorithm>

#include "geom/relax/yarn_terms.h"

namespace wale {

Closest closest_of(const PeriodicYarns& yarns, const std::vector<YarnSegment>& segments, const SegmentPair& pair) {
  const YarnSegment &f = segments[pair.first], &g = segments[pair.second];
  const dvec3 p = yarns.points[f.a], q = yarns.points[g.a] + dvec3(dvec2(pair.image) * yarns.period, 0.0);
  return closest_points(p, p + edge_of(yarns, f), q, q + edge_of(yarns, g));
}

PeriodicYarns moved(const PeriodicYarns& yarns, const TileStep& step, double share) {
  PeriodicYarns out = yarns;
  const dvec3 scale(1 + share * step.strain.x, 1 + share * step.strain.y, 1);
  for (size_t i = 0; i < out.points.size(); ++i) out.points[i] = scale * out.points[i] + share * step.points[i];
  out.period *= dvec2(scale);
  return out;
}

double safe_share(const PeriodicYarns& yarns, const std::vector<YarnSegment>& segments,
                  const std::vector<SegmentPair>& near, double reach, double keep, const TileStep& step) {
  constexpr double kOfDistance = 0.9;
  double own = 0;
  for (const dvec3& u : step.points) own = std::max(own, glm::length(u));
  const double affine = std::max(std::abs(step.strain.x), std::abs(step.strain.y));
  double share = 1;
  if (const double motion = affine * reach + 2 * own; motion > 0) share = std::min(share, (reach - keep) / motion);
  const dvec3 strain(step.strain, 0);
  for (const SegmentPair& pair : near) {
    const YarnSegment &f = segments[pair.first], &g = segments[pair.second];
    const dvec3 p = yarns.points[f.a], q = yarns.points[g.a] + dvec3(dvec2(pair.image) * yarns.period, 0.0);
    const dvec3 p1 = p + edge_of(yarns, f), q1 = q + edge_of(yarns, g);
    const dvec3 ends[] = {strain * p + step.points[f.a], strain * p1 + step.points[f.b]};
    const dvec3 others[] = {strain * q + step.points[g.a], strain * q1 + step.points[g.b]};
    double motion = 0;
    for (const dvec3& a : ends)
      for (const dvec3& b : others) motion = std::max(motion, glm::length(a - b));
    if (motion > 0) share = std::min(share, kOfDistance * glm::length(closest_points(p, p1, q, q1).way) / motion);
  }
  return share;
}

}  // namespace wale
