#include "geom/strain_field.h"

#include <algorithm>
#include <cmath>

#include "geom/mesh_edges.h"

namespace wale {
namespace {

/// Strains are kept to this: rounding in a mesh that is not strained must not move anything. A thousandth of a per
/// mille moves a yarn by a millionth of a stitch.
constexpr double kStrainStep = 1.0 / (1 << 20);

/// Corners of one vertex whose UVs meet.
struct Meeting {
  dvec2 uv{0, 0}, sum{0, 0};
  double weight = 0;
};

bool meet(dvec2 a, dvec2 b, const std::vector<dvec2>& joins, double tolerance) {
  for (const dvec2 join : joins)
    for (const int axis : {0, 1}) {
      if (!(join[axis] > 0)) continue;
      const double turns = std::round((a - b)[axis] / join[axis]);
      if (std::abs((a - b)[axis] - turns * join[axis]) <= kJoinTolerance * join[axis]) b[axis] = a[axis];
    }
  return glm::length(a - b) <= tolerance;
}

}  // namespace

StrainField::StrainField(const BaseMesh& mesh, const Chart& chart, dvec2 relaxed) : corner_(mesh.triangle.size()) {
  const double tolerance = uv_tolerance(mesh);
  std::vector<std::vector<Meeting>> meetings(mesh.position.size());
  const auto meeting = [&](uint32_t triangle, int corner) -> Meeting& {
    auto& here = meetings[mesh.triangle[triangle][corner]];
    const dvec2 uv = mesh.uv[triangle][corner];
    for (Meeting& one : here)
      if (meet(uv, one.uv, chart.joins, tolerance)) return one;
    here.push_back({uv, {0, 0}, 0});
    return here.back();
  };
  for (const uint32_t t : chart.triangles) {
    dvec3 du, dv;
    if (!uv_gradient(mesh, t, du, dv)) continue;
    const double weight = std::abs(uv_area2(mesh.uv[t]));
    const dvec2 strain = dvec2(glm::length(du), glm::length(dv)) / relaxed - 1.0;
    for (int corner = 0; corner < 3; ++corner) {
      Meeting& one = meeting(t, corner);
      one.sum += weight * strain;
      one.weight += weight;
    }
  }
  for (const uint32_t t : chart.triangles)
    for (int corner = 0; corner < 3; ++corner) {
      const Meeting& one = meeting(t, corner);
      if (one.weight > 0) corner_[t][corner] = glm::round(one.sum / one.weight / kStrainStep) * kStrainStep;
    }
}

dvec2 StrainField::at(const ChartPoint& place) const {
  dvec3 weight = glm::max(dvec3(1 - place.b1 - place.b2, place.b1, place.b2), dvec3(0));
  weight /= weight.x + weight.y + weight.z;
  const auto& corner = corner_[place.triangle];
  // As differences: where all corners agree, so does every place between.
  return corner[0] + weight.y * (corner[1] - corner[0]) + weight.z * (corner[2] - corner[0]);
}

}  // namespace wale
