#include "geom/lattice.h"

#include <algorithm>
#include <cmath>

#include "geom/error.h"
#include "geom/mesh_edges.h"
#include "geom/warp.h"

namespace wale {
namespace {

constexpr double kRectangle = 1e-6;  ///< share of the box's area that a rectangular chart may miss or cover twice

dvec3 unit_normal(const BaseMesh& mesh, const ChartPoint& at) {
  return warp_point(mesh, at, 1) - warp_point(mesh, at, 0);
}

}  // namespace

std::string lattice_obstacle(const BaseMesh& mesh, const Chart& chart) {
  double area = 0, covered = 0;
  for (const uint32_t t : chart.triangles) {
    area += 0.5 * uv_area2(mesh.uv[t]);
    covered += 0.5 * std::abs(uv_area2(mesh.uv[t]));
  }
  const dvec2 extent = chart.uv_max - chart.uv_min;
  const double box = extent.x * extent.y;
  if (std::abs(covered - box) > kRectangle * box) return "a UV chart of its mesh is not a rectangle";
  if (covered - std::abs(area) > kRectangle * box) return "a UV chart of its mesh folds over itself";
  return {};
}

Lattice sample_lattice(const BaseMesh& mesh, const Chart& chart, dvec2 origin, dvec2 tile_uv, ivec2 tiles, ivec2 wrap,
                       int cells, ivec2 reach_lo, ivec2 reach_hi, size_t most) {
  Lattice lattice;
  lattice.tiles = tiles;
  lattice.wrap = wrap;
  lattice.cells = cells;
  lattice.margin = glm::max(-reach_lo, ivec2(0));
  lattice.size = lattice.margin + (tiles - 1) * cells + reach_hi + 2;
  const size_t count = size_t(lattice.size.x) * size_t(lattice.size.y);
  if (count > most)
    user_error(
        "fabric: {} x {} tiles of {} x {} lattice cells are {:.3g} vertices, more than the {:.3g} that can be "
        "numbered; use fewer repeats, a smaller \"lattice\" or storage \"stored\" without one",
        tiles.x, tiles.y, cells, cells, double(count), double(most));
  lattice.position.resize(count);
  lattice.normal.resize(count);
  const ChartLocator locator(mesh, chart);
  const ivec2 around = tiles * cells * wrap;
  const dvec2 past = tile_uv * chart.metres_per_uv * dvec2(glm::max(lattice.margin, reach_hi + 1)) / double(cells);
  const double reach = 1.01 * glm::length(past);
  for (int y = 0; y < lattice.size.y; ++y)
    for (int x = 0; x < lattice.size.x; ++x) {
      ivec2 at = ivec2(x, y) - lattice.margin;
      for (int k = 0; k < 2; ++k)
        if (around[k] > 0) at[k] = (at[k] % around[k] + around[k]) % around[k];
      const dvec2 uv = origin + tile_uv * (dvec2(at) / double(cells));
      ChartPoint point;
      if (!locator.locate(uv, reach, chart.metres_per_uv, point))
        bug("lattice: UV {}, {} lies on no triangle", uv.x, uv.y);
      const size_t i = size_t(x) + size_t(lattice.size.x) * size_t(y);
      lattice.position[i] = warp_point(mesh, point, 0);
      lattice.normal[i] = unit_normal(mesh, point);
    }
  return lattice;
}

}  // namespace wale
