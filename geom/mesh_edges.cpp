#include "geom/mesh_edges.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace wale {

std::vector<TriangleSide> sorted_sides(const BaseMesh& mesh) {
  std::vector<TriangleSide> sides;
  sides.reserve(3 * mesh.triangle.size());
  for (uint32_t t = 0; t < mesh.triangle.size(); ++t)
    for (uint32_t c = 0; c < 3; ++c) {
      const uint32_t a = mesh.triangle[t][c], b = mesh.triangle[t][(c + 1) % 3];
      if (a != b) sides.push_back({std::min(a, b), std::max(a, b), t, c});
    }
  std::sort(sides.begin(), sides.end(), [](const TriangleSide& a, const TriangleSide& b) {
    return std::tie(a.lo, a.hi, a.triangle, a.corner) < std::tie(b.lo, b.hi, b.triangle, b.corner);
  });
  return sides;
}

std::array<dvec2, 2> side_uv(const BaseMesh& mesh, const TriangleSide& side) {
  const auto& uv = mesh.uv[side.triangle];
  const uint32_t next = (side.corner + 1) % 3;
  if (mesh.triangle[side.triangle][side.corner] == side.lo) return {uv[side.corner], uv[next]};
  return {uv[next], uv[side.corner]};
}

double uv_tolerance(const BaseMesh& mesh) {
  double largest = 0;
  for (const auto& t : mesh.uv)
    for (const dvec2& uv : t) largest = std::max({largest, std::abs(uv.x), std::abs(uv.y)});
  return 1e-9 * largest;
}

bool same_uv(const BaseMesh& mesh, const TriangleSide& a, const TriangleSide& b, double tolerance) {
  const auto p = side_uv(mesh, a), q = side_uv(mesh, b);
  for (size_t k = 0; k < 2; ++k)
    if (std::abs(p[k].x - q[k].x) > tolerance || std::abs(p[k].y - q[k].y) > tolerance) return false;
  return true;
}

bool uv_gradient(const BaseMesh& mesh, uint32_t triangle, dvec3& du, dvec3& dv) {
  const auto& uv = mesh.uv[triangle];
  const double det = uv_area2(uv);
  if (det == 0) return false;
  const auto& t = mesh.triangle[triangle];
  const dvec3 p1 = mesh.position[t[1]] - mesh.position[t[0]], p2 = mesh.position[t[2]] - mesh.position[t[0]];
  const dvec2 e1 = uv[1] - uv[0], e2 = uv[2] - uv[0];
  du = (p1 * e2.y - p2 * e1.y) / det;
  dv = (p2 * e1.x - p1 * e2.x) / det;
  return true;
}

}  // namespace wale
