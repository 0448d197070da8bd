#include "geom/warp.h"

#include "geom/mesh_edges.h"

namespace wale {
namespace {

/// Interpolated normal, not yet of unit length; the triangle's own where the vertex normals cancel.
dvec3 raw_normal(const BaseMesh& mesh, const ChartPoint& at, bool& varies) {
  const auto& t = mesh.triangle[at.triangle];
  const dvec3 n = (1 - at.b1 - at.b2) * mesh.normal[t[0]] + at.b1 * mesh.normal[t[1]] + at.b2 * mesh.normal[t[2]];
  varies = glm::dot(n, n) > 1e-12;
  if (varies) return n;
  const dvec3 face = glm::cross(mesh.position[t[1]] - mesh.position[t[0]], mesh.position[t[2]] - mesh.position[t[0]]);
  return glm::dot(face, face) > 0 ? face : dvec3(0, 0, 1);
}

}  // namespace

dvec3 warp_point(const BaseMesh& mesh, const ChartPoint& at, double height) {
  const auto& t = mesh.triangle[at.triangle];
  const dvec3 base =
      (1 - at.b1 - at.b2) * mesh.position[t[0]] + at.b1 * mesh.position[t[1]] + at.b2 * mesh.position[t[2]];
  if (height == 0) return base;
  bool varies = false;
  return base + height * glm::normalize(raw_normal(mesh, at, varies));
}

// W = P + h n/|n| with P and n linear in uv, so dW/du = dP/du + h (dn/du - N (N . dn/du)) / |n|.
dmat3 warp_jacobian(const BaseMesh& mesh, const ChartPoint& at, double height, dvec2 uv_per_metre) {
  const auto& t = mesh.triangle[at.triangle];
  const auto& uv = mesh.uv[at.triangle];
  bool varies = false;
  const dvec3 raw = raw_normal(mesh, at, varies);
  const double size = glm::length(raw);
  const dvec3 normal = raw / size;

  dvec3 column[2] = {dvec3(0), dvec3(0)};
  if (uv_gradient(mesh, at.triangle, column[0], column[1]) && varies) {
    const dvec2 e1 = uv[1] - uv[0], e2 = uv[2] - uv[0];
    const double det = uv_area2(uv);
    const dvec3 n1 = mesh.normal[t[1]] - mesh.normal[t[0]], n2 = mesh.normal[t[2]] - mesh.normal[t[0]];
    const dvec3 slope[2] = {(n1 * e2.y - n2 * e1.y) / det, (n2 * e1.x - n1 * e2.x) / det};
    for (int k = 0; k < 2; ++k) column[k] += height / size * (slope[k] - normal * glm::dot(normal, slope[k]));
  }
  return dmat3(column[0] * uv_per_metre.x, column[1] * uv_per_metre.y, normal);
}

}  // namespace wale
