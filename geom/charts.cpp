#include "geom/charts.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "geom/error.h"
#include "geom/groups.h"
#include "geom/mesh_edges.h"

namespace wale {
namespace {

/// A translation must hold along this share of the chart's own seams, and reach across this share of its box.
constexpr double kJoinShare = 0.25, kJoinExtent = 0.5;

/// A translation found along a seam, with the UV length of the seam that has it.
struct SeamShift {
  dvec2 shift{0, 0};
  double length = 0;
};

void add_shift(std::vector<SeamShift>& found, dvec2 shift, double length) {
  if (shift.x < 0 || (shift.x == 0 && shift.y < 0)) shift = -shift;
  for (SeamShift& s : found)
    if (glm::length(s.shift - shift) <= kJoinTolerance * glm::length(shift)) {
      s.length += length;
      return;
    }
  found.push_back({shift, length});
}

/// Keeps the longest axis-parallel translation along u and along v.
void choose_joins(Chart& chart, const std::vector<SeamShift>& found, double seam_length) {
  for (int axis = 0; axis < 2; ++axis) {
    const SeamShift* best = nullptr;
    for (const SeamShift& s : found) {
      const double along = std::abs(s.shift[axis]), across = std::abs(s.shift[1 - axis]);
      if (across > kJoinTolerance * along) continue;
      if (along < kJoinExtent * (chart.uv_max - chart.uv_min)[axis]) continue;
      if (s.length < kJoinShare * seam_length) continue;
      if (!best || s.length > best->length) best = &s;
    }
    if (!best) continue;
    dvec2 join(0);
    join[axis] = std::abs(best->shift[axis]);
    chart.joins.push_back(join);
  }
}

void measure(const BaseMesh& mesh, Chart& chart) {
  chart.uv_min = dvec2(INFINITY);
  chart.uv_max = dvec2(-INFINITY);
  double area = 0, signed_area = 0;
  dvec2 metres(0);
  for (const uint32_t t : chart.triangles) {
    for (const dvec2& uv : mesh.uv[t]) {
      chart.uv_min = glm::min(chart.uv_min, uv);
      chart.uv_max = glm::max(chart.uv_max, uv);
    }
    dvec3 du, dv;
    if (!uv_gradient(mesh, t, du, dv)) continue;
    const double weight = uv_area2(mesh.uv[t]);
    signed_area += weight;
    area += std::abs(weight);
    metres += std::abs(weight) * dvec2(glm::length(du), glm::length(dv));
  }
  if (area > 0) chart.metres_per_uv = metres / area;
  chart.mirrored = signed_area < 0;
}

/// The scale of the chart at rest that lies in the same place, by the share that their boxes have in common.
void take_scale(std::vector<Chart>& charts, const std::vector<Chart>& rest, const std::string& name) {
  const auto area = [](dvec2 lo, dvec2 hi) {
    const dvec2 size = glm::max(hi - lo, dvec2(0));
    return size.x * size.y;
  };
  for (Chart& chart : charts) {
    if (!(area(chart.uv_min, chart.uv_max) > 0)) continue;
    const Chart* best = nullptr;
    double best_share = 0.5;
    for (const Chart& other : rest) {
      const double common = area(glm::max(chart.uv_min, other.uv_min), glm::min(chart.uv_max, other.uv_max));
      const double share = common / (area(chart.uv_min, chart.uv_max) + area(other.uv_min, other.uv_max) - common);
      if (share > best_share) best_share = share, best = &other;
    }
    if (!best)
      user_error(
          "{}: its chart of UV ({:.3g}, {:.3g}) to ({:.3g}, {:.3g}) is not in the rest frame; UV must be those of the "
          "same cloth in every frame",
          name, chart.uv_min.x, chart.uv_min.y, chart.uv_max.x, chart.uv_max.y);
    chart.metres_per_uv = best->metres_per_uv;
  }
}

}  // namespace

std::vector<Chart> find_charts(const BaseMesh& mesh) {
  if (mesh.uv.empty()) return {};
  const auto sides = sorted_sides(mesh);
  const double tolerance = uv_tolerance(mesh);
  Groups groups(mesh.triangle.size());
  for_each_edge(sides, [&](std::span<const TriangleSide> edge) {
    for (size_t i = 1; i < edge.size(); ++i)
      for (size_t j = 0; j < i; ++j)
        if (same_uv(mesh, edge[i], edge[j], tolerance)) groups.join(edge[i].triangle, edge[j].triangle);
  });

  std::vector<Chart> charts;
  std::vector<uint32_t> chart_of(mesh.triangle.size());
  for (uint32_t t = 0; t < mesh.triangle.size(); ++t) {
    const uint32_t first = groups.find(t);
    if (first == t) {
      chart_of[t] = static_cast<uint32_t>(charts.size());
      charts.emplace_back();
    }
    chart_of[t] = chart_of[first];
    charts[chart_of[t]].triangles.push_back(t);
  }
  for (Chart& chart : charts) measure(mesh, chart);
  if (mesh.rest) take_scale(charts, find_charts(*mesh.rest), mesh.name);

  std::vector<std::vector<SeamShift>> shifts(charts.size());
  std::vector<double> seam_length(charts.size(), 0.0);
  for_each_edge(sides, [&](std::span<const TriangleSide> edge) {
    if (edge.size() != 2 || chart_of[edge[0].triangle] != chart_of[edge[1].triangle]) return;
    if (same_uv(mesh, edge[0], edge[1], tolerance)) return;
    const uint32_t chart = chart_of[edge[0].triangle];
    const auto a = side_uv(mesh, edge[0]), b = side_uv(mesh, edge[1]);
    const double length = glm::length(a[1] - a[0]);
    seam_length[chart] += length;
    const dvec2 start = b[0] - a[0], end = b[1] - a[1];
    const bool same_sense = uv_area2(mesh.uv[edge[0].triangle]) * uv_area2(mesh.uv[edge[1].triangle]) > 0;
    if (same_sense && glm::length(start - end) <= kJoinTolerance * glm::length(start))
      add_shift(shifts[chart], start, length);
  });
  for (size_t c = 0; c < charts.size(); ++c) choose_joins(charts[c], shifts[c], seam_length[c]);
  return charts;
}

}  // namespace wale
