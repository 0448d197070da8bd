#include "host/ply_reach.h"

#include <algorithm>
#include <cmath>

namespace wale {
namespace {

// A mitre's spike passes 2 radii nowhere (kernels/geometry/joint.clh).
constexpr double kSpike = 2;
// Rounding of the device's floats and of a normal that is not quite unit.
constexpr double kRoom = 1.01;

double longest_edge(const BaseMesh& mesh) {
  double longest = 0;
  for (const auto& t : mesh.triangle)
    for (size_t k = 0; k < 3; ++k)
      longest = std::max(longest, glm::length(mesh.position[t[k]] - mesh.position[t[(k + 1) % 3]]));
  return longest;
}

}  // namespace

PlyReach ply_reach(const Fabric& fabric) {
  PlyReach reach;
  double highest = 0, thickest = std::max(fabric.ply_radius, fabric.flyaway_radius);
  for (const PlyRun& run : fabric.runs) thickest = std::max(thickest, double(run.radius));
  if (!fabric.lattice.empty()) {
    for (const LatticeChart& chart : fabric.lattice) {
      reach.points.insert(reach.points.end(), chart.lattice.position.begin(), chart.lattice.position.end());
      highest = std::max(highest, chart.tile.highest);
    }
  } else {
    for (const auto& t : fabric.mesh.triangle)
      for (const uint32_t v : t) reach.points.push_back(fabric.mesh.position[v]);
    // Past the borders weights are negative, by `excess` at most: such a point, sum of w_k v_k, lies within
    // 3 excess |q - c| of a point q of the triangle of middle c, and |q - c| is below 2/3 of the longest edge.
    double excess = 0;
    for (const Anchor& a : fabric.anchors) {
      highest = std::max(highest, std::abs(double(a.height)));
      excess = std::max({excess, -double(a.b1), -double(a.b2), double(a.b1) + double(a.b2) - 1});
    }
    if (excess > 0) reach.slack = 2 * excess * longest_edge(fabric.mesh);
  }
  reach.slack = kRoom * (reach.slack + highest + kSpike * thickest);
  return reach;
}

double PlyReach::along(const dvec3& n) const {
  double most = -INFINITY;
  for (const dvec3& p : points) most = std::max(most, glm::dot(n, p));
  return most + slack;
}

double PlyReach::distance(const dvec3& x) const {
  if (points.empty()) return INFINITY;
  dvec3 lo = points.front(), hi = lo;
  for (const dvec3& p : points) lo = glm::min(lo, p), hi = glm::max(hi, p);
  const dvec3 outside = glm::max(glm::max(lo - slack - x, x - hi - slack), dvec3(0));
  return glm::length(outside);
}

}  // namespace wale
