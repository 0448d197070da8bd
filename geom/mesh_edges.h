#pragma once
#include <span>
#include <vector>

#include "geom/base_mesh.h"

namespace wale {

/// Side `corner` -> `corner`+1 of a triangle.
struct TriangleSide {
  uint32_t lo = 0, hi = 0;  ///< vertices, lo < hi
  uint32_t triangle = 0, corner = 0;
};

/// All sides between different vertices, sorted so that sides of one edge are neighbours (then by triangle).
std::vector<TriangleSide> sorted_sides(const BaseMesh& mesh);

/// Calls visit(span of sides) once for each edge.
template <typename Visit>
void for_each_edge(const std::vector<TriangleSide>& sides, Visit&& visit) {
  for (size_t begin = 0, end; begin < sides.size(); begin = end) {
    end = begin + 1;
    while (end < sides.size() && sides[end].lo == sides[begin].lo && sides[end].hi == sides[begin].hi) ++end;
    visit(std::span(sides).subspan(begin, end - begin));
  }
}

/// UV of the side at its lower and at its higher vertex.
std::array<dvec2, 2> side_uv(const BaseMesh& mesh, const TriangleSide& side);

/// Largest distance between UVs that still count as the same: 1e-9 of the UVs' magnitude.
double uv_tolerance(const BaseMesh& mesh);

/// True when the two sides carry the same UV at both vertices.
bool same_uv(const BaseMesh& mesh, const TriangleSide& a, const TriangleSide& b, double tolerance);

/// Twice the signed area of a UV triangle.
inline double uv_area2(const std::array<dvec2, 3>& t) {
  return (t[1].x - t[0].x) * (t[2].y - t[0].y) - (t[1].y - t[0].y) * (t[2].x - t[0].x);
}

/// Columns dP/du, dP/dv of the linear map UV -> space of a triangle; false when its UV area is zero.
bool uv_gradient(const BaseMesh& mesh, uint32_t triangle, dvec3& du, dvec3& dv);

}  // namespace wale
