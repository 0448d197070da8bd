#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "geom/base_mesh.h"
#include "geom/charts.h"
#include "geom/mesh_edges.h"

namespace wale {
namespace {

constexpr int kOverlapRaster = 1024;

/// Share of covered raster points that more than one of the triangles covers. Points on an outline count for no
/// triangle, so that neighbours never seem to overlap.
double uv_overlap(const BaseMesh& mesh, std::span<const uint32_t> triangles) {
  dvec2 lo(INFINITY), hi(-INFINITY);
  for (const uint32_t number : triangles)
    for (const dvec2& uv : mesh.uv[number]) {
      lo = glm::min(lo, uv);
      hi = glm::max(hi, uv);
    }
  const dvec2 step = (hi - lo) / static_cast<double>(kOverlapRaster);
  if (!(step.x > 0 && step.y > 0)) return 0;

  std::vector<uint8_t> layers(static_cast<size_t>(kOverlapRaster) * kOverlapRaster, 0);
  for (const uint32_t number : triangles) {
    const auto& t = mesh.uv[number];
    const double area2 = uv_area2(t);
    if (area2 == 0) continue;
    const dvec2 a = glm::min(t[0], glm::min(t[1], t[2])), b = glm::max(t[0], glm::max(t[1], t[2]));
    const auto first = glm::max(ivec2(glm::ceil((a - lo) / step - 0.5)), ivec2(0));
    const auto last = glm::min(ivec2(glm::floor((b - lo) / step - 0.5)), ivec2(kOverlapRaster - 1));
    for (int y = first.y; y <= last.y; ++y)
      for (int x = first.x; x <= last.x; ++x) {
        const dvec2 p = lo + (dvec2(x, y) + 0.5) * step;
        const double b1 = uv_area2({t[0], p, t[2]}) / area2, b2 = uv_area2({t[0], t[1], p}) / area2;
        if (b1 <= 1e-9 || b2 <= 1e-9 || b1 + b2 >= 1 - 1e-9) continue;
        uint8_t& n = layers[static_cast<size_t>(y) * kOverlapRaster + static_cast<size_t>(x)];
        n = static_cast<uint8_t>(std::min(n + 1, 2));
      }
  }
  size_t covered = 0, twice = 0;
  for (const uint8_t n : layers) {
    covered += n > 0;
    twice += n > 1;
  }
  return covered ? static_cast<double>(twice) / static_cast<double>(covered) : 0;
}

double median(std::vector<double>& values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Singular values of the 3x2 matrix (du dv), larger first, from its Gram matrix.
dvec2 singular_values(dvec3 du, dvec3 dv) {
  const double a = glm::dot(du, du), b = glm::dot(du, dv), c = glm::dot(dv, dv);
  const double mean = 0.5 * (a + c), spread = std::hypot(0.5 * (a - c), b);
  const double area = glm::length(glm::cross(du, dv)), larger = std::sqrt(mean + spread);
  return {larger, larger > 0 ? area / larger : 0};
}

}  // namespace

MeshReport validate(const BaseMesh& mesh) {
  MeshReport report;
  report.vertices = mesh.position.size();
  report.triangles = mesh.triangle.size();
  report.polygons_split = mesh.polygons_split;

  for (const auto& t : mesh.triangle) {
    const dvec3 a = mesh.position[t[0]];
    if (glm::length(glm::cross(mesh.position[t[1]] - a, mesh.position[t[2]] - a)) == 0) ++report.degenerate_triangles;
  }
  const double tolerance = uv_tolerance(mesh);
  for_each_edge(sorted_sides(mesh), [&](std::span<const TriangleSide> edge) {
    report.boundary_edges += edge.size() == 1;
    report.non_manifold_edges += edge.size() > 2;
    if (mesh.uv.empty()) return;
    for (size_t i = 1; i < edge.size(); ++i)
      if (!same_uv(mesh, edge[0], edge[i], tolerance)) {
        ++report.seam_edges;
        break;
      }
  });
  if (mesh.uv.empty()) return report;

  std::vector<double> larger, smaller;
  std::vector<uint32_t> all(mesh.triangle.size());
  std::iota(all.begin(), all.end(), 0u);
  report.overlap = uv_overlap(mesh, all);
  double covered = 0;
  for (const Chart& chart : find_charts(mesh)) {
    double area = 0;
    for (const uint32_t t : chart.triangles) {
      dvec3 du, dv;
      if (!uv_gradient(mesh, t, du, dv)) {
        ++report.zero_area_uv;
        continue;
      }
      area += std::abs(uv_area2(mesh.uv[t]));
      report.flipped_uv += (uv_area2(mesh.uv[t]) < 0) != chart.mirrored;
      const dvec2 stretch = singular_values(du, dv);
      larger.push_back(stretch.x);
      smaller.push_back(stretch.y);
    }
    // Where no two triangles of the whole mesh overlap, none of a chart do.
    if (report.overlap > 0 && chart.triangles.size() > 1)
      report.chart_overlap += area * uv_overlap(mesh, chart.triangles);
    covered += area;
  }
  if (covered > 0) report.chart_overlap /= covered;
  report.stretch_median = {median(larger), median(smaller)};
  return report;
}

}  // namespace wale
