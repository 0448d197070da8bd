#include "geom/mesh_repair.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "geom/groups.h"
#include "geom/mesh_edges.h"

namespace wale {
namespace {

bool before(const dvec3& a, const dvec3& b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); }

/// A border edge with its ends in the order of their places.
struct Border {
  dvec3 lo, hi;
  TriangleSide side;
  bool forward;  ///< its triangle runs from lo to hi
  std::array<uint32_t, 2> vertex;
  std::array<dvec2, 2> uv;
};

Border border_of(const BaseMesh& mesh, const TriangleSide& side) {
  const auto& t = mesh.triangle[side.triangle];
  const uint32_t from = t[side.corner], to = t[(side.corner + 1) % 3];
  const bool forward = before(mesh.position[from], mesh.position[to]);
  Border b{mesh.position[from], mesh.position[to], side, forward, {from, to}, {dvec2(0), dvec2(0)}};
  if (!mesh.uv.empty()) b.uv = {mesh.uv[side.triangle][side.corner], mesh.uv[side.triangle][(side.corner + 1) % 3]};
  if (!forward) {
    std::swap(b.lo, b.hi);
    std::swap(b.vertex[0], b.vertex[1]);
    std::swap(b.uv[0], b.uv[1]);
  }
  return b;
}

dvec3 face_normal(const BaseMesh& mesh, uint32_t triangle) {
  const auto& t = mesh.triangle[triangle];
  return glm::cross(mesh.position[t[1]] - mesh.position[t[0]], mesh.position[t[2]] - mesh.position[t[0]]);
}

// Cosine of the angle between face normals beyond which two sides lie back to back: averages of theirs would cancel.
constexpr double kBackToBack = -0.9;

/// The two lie on the two sides of their edge, in space by their sense and, where their UVs agree, in UV too; and they
/// are no two layers of a doubled sheet, which meet along its border with opposite normals.
bool continue_each_other(const BaseMesh& mesh, const Border& a, const Border& b) {
  if (a.forward == b.forward) return false;
  const dvec3 n = face_normal(mesh, a.side.triangle), m = face_normal(mesh, b.side.triangle);
  if (glm::dot(n, m) < kBackToBack * glm::length(n) * glm::length(m)) return false;
  if (mesh.uv.empty() || a.uv != b.uv) return true;
  return uv_area2(mesh.uv[a.side.triangle]) * uv_area2(mesh.uv[b.side.triangle]) > 0;
}

bool same_sense(const BaseMesh& mesh, const TriangleSide& side) {
  return mesh.triangle[side.triangle][side.corner] == side.lo;
}

}  // namespace

size_t join_duplicate_vertices(BaseMesh& mesh) {
  std::vector<Border> borders;
  for_each_edge(sorted_sides(mesh), [&](std::span<const TriangleSide> edge) {
    if (edge.size() != 1) return;
    const Border b = border_of(mesh, edge[0]);
    if (b.lo != b.hi) borders.push_back(b);
  });
  const auto place_less = [](const Border& a, const Border& b) {
    if (a.lo != b.lo) return before(a.lo, b.lo);
    if (a.hi != b.hi) return before(a.hi, b.hi);
    return std::tie(a.side.triangle, a.side.corner) < std::tie(b.side.triangle, b.side.corner);
  };
  std::sort(borders.begin(), borders.end(), place_less);
  Groups groups(mesh.position.size());
  for (size_t i = 0; i < borders.size();) {
    size_t end = i + 1;
    while (end < borders.size() && borders[end].lo == borders[i].lo && borders[end].hi == borders[i].hi) ++end;
    if (end - i == 2 && continue_each_other(mesh, borders[i], borders[i + 1]))
      for (int k = 0; k < 2; ++k) groups.join(borders[i].vertex[k], borders[i + 1].vertex[k]);
    i = end;
  }
  size_t joined = 0;
  for (uint32_t v = 0; v < mesh.position.size(); ++v) joined += groups.find(v) != v;
  if (joined == 0) return 0;
  for (auto& t : mesh.triangle)
    for (uint32_t& v : t) v = groups.find(v);
  compute_normals(mesh);
  return joined;
}

size_t part_opposed_seams(BaseMesh& mesh) {
  // Corners 3 t + k of one vertex belong together where their triangles share an edge that is no opposed seam.
  Groups corners(3 * mesh.triangle.size());
  std::vector<bool> touched(mesh.position.size(), false);
  const double tolerance = uv_tolerance(mesh);
  const auto corner_at = [&](const TriangleSide& s, uint32_t vertex) {
    const uint32_t k = mesh.triangle[s.triangle][s.corner] == vertex ? s.corner : (s.corner + 1) % 3;
    return 3 * s.triangle + k;
  };
  for_each_edge(sorted_sides(mesh), [&](std::span<const TriangleSide> edge) {
    for (size_t i = 1; i < edge.size(); ++i)
      for (size_t j = 0; j < i; ++j) {
        const bool opposed = same_sense(mesh, edge[i]) == same_sense(mesh, edge[j]);
        const bool seam = !same_uv(mesh, edge[i], edge[j], tolerance);
        if (seam && (opposed || edge.size() > 2)) {
          touched[edge[i].lo] = touched[edge[i].hi] = true;
          continue;
        }
        for (const uint32_t v : {edge[i].lo, edge[i].hi}) corners.join(corner_at(edge[i], v), corner_at(edge[j], v));
      }
  });
  constexpr uint32_t kNone = 0xffffffffu;
  std::vector<uint32_t> first(mesh.position.size(), kNone), copy(3 * mesh.triangle.size(), kNone);
  const size_t vertices = mesh.position.size();
  for (uint32_t t = 0; t < mesh.triangle.size(); ++t)
    for (uint32_t k = 0; k < 3; ++k) {
      const uint32_t v = mesh.triangle[t][k], group = corners.find(3 * t + k);
      if (!touched[v]) continue;
      if (first[v] == kNone) first[v] = group;
      if (group == first[v]) continue;
      if (copy[group] == kNone) {
        copy[group] = uint32_t(mesh.position.size());
        mesh.position.push_back(mesh.position[v]);
      }
      mesh.triangle[t][k] = copy[group];
    }
  const size_t added = mesh.position.size() - vertices;
  if (added) compute_normals(mesh);
  return added;
}

}  // namespace wale
