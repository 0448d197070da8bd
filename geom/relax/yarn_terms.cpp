#include "geom/relax/yarn_terms.h"

#include <algorithm>

namespace wale {
namespace {

dmat3 across(const dvec3& t) { return dmat3(1.0) - glm::outerProduct(t, t); }

}  // namespace

dvec3 edge_of(const PeriodicYarns& yarns, const YarnSegment& segment) {
  return yarns.points[segment.b] - yarns.points[segment.a] + dvec3(dvec2(segment.shift) * yarns.period, 0.0);
}

LocalTerm stretch_term(const PeriodicYarns& yarns, const YarnSegment& segment, double stiffness, Order order) {
  LocalTerm out;
  out.count = 2;
  out.point[0] = segment.a, out.point[1] = segment.b;
  const dvec3 v = edge_of(yarns, segment);
  const double length = glm::length(v), strain = length / segment.length - 1;
  out.energy = 0.5 * stiffness * segment.length * strain * strain;
  if (order == Order::energy) return out;
  const dvec3 t = v / length;
  const double pull = stiffness * strain;
  const double weight[] = {-1, 1};
  out.add(weight, v, pull * t, stiffness / segment.length * glm::outerProduct(t, t) + pull / length * across(t));
  return out;
}

// With P = 1 - t t^T and c = t1.t2: the gradient by v1 is -P1 t2 / (l0 l1), the mixed second derivative is
// -P1 P2 / (l0 l1 l2), and that by v1 twice (c P1 + t1 (P1 t2)^T + (P1 t2) t1^T) / (l0 l1^2).
LocalTerm bending_term(const PeriodicYarns& yarns, const YarnSegment& first, const YarnSegment& second, Order order) {
  LocalTerm out;
  out.count = 3;
  out.point[0] = first.a, out.point[1] = first.b, out.point[2] = second.b;
  const dvec3 v1 = edge_of(yarns, first), v2 = edge_of(yarns, second);
  const double l1 = glm::length(v1), l2 = glm::length(v2);
  const dvec3 t1 = v1 / l1, t2 = v2 / l2, bend = t2 - t1;
  const double stiffness = 2 / (first.length + second.length);
  out.energy = 0.5 * stiffness * glm::dot(bend, bend);
  if (order == Order::energy) return out;
  const double cosine = glm::dot(t1, t2);
  const dmat3 p1 = across(t1), p2 = across(t2);
  const dvec3 side1 = p1 * t2, side2 = p2 * t1;
  const auto twice = [&](const dmat3& p, const dvec3& t, const dvec3& side, double l) {
    return stiffness / (l * l) * (cosine * p + glm::outerProduct(t, side) + glm::outerProduct(side, t));
  };
  const double weight1[] = {-1, 1, 0}, weight2[] = {0, -1, 1};
  out.add(weight1, v1, -stiffness / l1 * side1, twice(p1, t1, side1, l1));
  out.add(weight2, v2, -stiffness / l2 * side2, twice(p2, t2, side2, l2));
  out.add_mixed(weight1, v1, weight2, v2, -stiffness / (l1 * l2) * (p1 * p2));
  return out;
}

}  // namespace wale
