#pragma once
#include <algorithm>

#include "geom/base_mesh.h"

namespace wale {

/// Box around what a scene is made of, in double.
struct Bounds {
  dvec3 lo{1e300, 1e300, 1e300}, hi{-1e300, -1e300, -1e300};
  void add(const dvec3& p) { lo = glm::min(lo, p), hi = glm::max(hi, p); }
  // What no triangle uses is not there: a forgotten vertex far away must not take the digits of the rest.
  void add(const BaseMesh& mesh) {
    for (const auto& t : mesh.triangle)
      for (const uint32_t v : t) add(mesh.position[v]);
  }
  bool empty() const { return lo.x > hi.x; }
  dvec3 centre() const { return 0.5 * (lo + hi); }
  double radius() const { return empty() ? 1.0 : std::max(1e-9, 0.5 * glm::length(hi - lo)); }
};

}  // namespace wale
