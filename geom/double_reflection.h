#pragma once
#include "geom/vec.h"

namespace wale {

/// Carries the frame normal `r` (unit, perpendicular to unit tangent t0) from (x0, t0) to (x1, t1) with least rotation:
/// double reflection, Wang, Juettler, Zheng and Liu 2008, table I; error of fourth order in the step.
inline dvec3 double_reflection(const dvec3& r, const dvec3& x0, const dvec3& t0, const dvec3& x1, const dvec3& t1) {
  // R1 reflects in the plane that bisects the points, R2 in the one that takes the reflected tangent to t1.
  dvec3 normal = r, tangent = t0;
  const dvec3 v1 = x1 - x0;
  const double c1 = glm::dot(v1, v1);
  if (c1 > 0) {
    normal -= 2 / c1 * glm::dot(v1, r) * v1;
    tangent -= 2 / c1 * glm::dot(v1, t0) * v1;
  }
  const dvec3 v2 = t1 - tangent;
  const double c2 = glm::dot(v2, v2);
  if (c2 > 1e-24) normal -= 2 / c2 * glm::dot(v2, normal) * v2;
  // Rounding would add up over a long yarn.
  return glm::normalize(normal - glm::dot(normal, t1) * t1);
}

/// A unit vector perpendicular to unit `t`: along z (through the fabric) where that is possible.
inline dvec3 any_normal(const dvec3& t) {
  const dvec3 axis = glm::abs(t.z) < 0.9 ? dvec3(0, 0, 1) : dvec3(1, 0, 0);
  return glm::normalize(axis - glm::dot(axis, t) * t);
}

}  // namespace wale
