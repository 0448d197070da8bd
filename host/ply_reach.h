#pragma once
#include "geom/fabric.h"

namespace wale {

/// What no curve of a fabric lies beyond: points whose convex hull, grown by `slack`, holds every ply and flyaway.
struct PlyReach {
  std::vector<dvec3> points;  ///< metres, not relative to any origin
  double slack = 0;           ///< metres

  /// Largest dot(n, x) of a point x of the fabric; n unit.
  double along(const dvec3& n) const;
  /// Smallest distance of a point of the fabric's box from x, at least 0.
  double distance(const dvec3& x) const;
};

PlyReach ply_reach(const Fabric& fabric);

}  // namespace wale
