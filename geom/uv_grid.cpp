#include "geom/uv_grid.h"

#include <algorithm>
#include <cmath>

#include "geom/mesh_edges.h"

namespace wale {
namespace {

/// Cells per tile along x and y, at least one; nearly square in cloth metres.
ivec2 cells_per_tile(double cells, dvec2 tile) {
  const int x = std::max(1, static_cast<int>(std::lround(std::sqrt(cells * tile.x / tile.y))));
  return {x, std::max(1, static_cast<int>(std::lround(cells / x)))};
}

int largest_divisor(int n, int at_most) {
  int k = std::max(1, std::min(n, at_most));
  while (n % k != 0) --k;
  return k;
}

/// Compressed rows from visit(emit), which calls emit(row, item) with items in ascending order, the same at each call.
/// Repeated pairs are kept once.
template <typename Visit>
Csr compress(size_t rows, Visit&& visit) {
  Csr csr;
  csr.offset.assign(rows + 1, 0);
  std::vector<uint32_t> last(rows, 0xffffffffu);
  visit([&](uint32_t row, uint32_t item) {
    if (last[row] == item) return;
    last[row] = item;
    ++csr.offset[row + 1];
  });
  for (size_t r = 0; r < rows; ++r) csr.offset[r + 1] += csr.offset[r];
  csr.item.resize(csr.offset.back());
  std::vector<uint32_t> next(csr.offset.begin(), csr.offset.end() - 1);
  std::fill(last.begin(), last.end(), 0xffffffffu);
  visit([&](uint32_t row, uint32_t item) {
    if (last[row] == item) return;
    last[row] = item;
    csr.item[next[row]++] = item;
  });
  return csr;
}

/// True when a line along a triangle side leaves the whole box on its outer side.
bool separated(const std::array<dvec2, 3>& t, dvec2 lo, dvec2 hi) {
  const double sign = uv_area2(t) > 0 ? 1 : -1;
  const dvec2 centre = 0.5 * (lo + hi), half = 0.5 * (hi - lo);
  for (size_t c = 0; c < 3; ++c) {
    const dvec2 a = t[c], e = t[(c + 1) % 3] - a;
    const double at_centre = sign * (e.x * (centre.y - a.y) - e.y * (centre.x - a.x));
    const double reach = std::abs(e.x) * half.y + std::abs(e.y) * half.x;
    if (at_centre + 1.000001 * reach < 0) return true;
  }
  return false;
}

}  // namespace

size_t cell_count(const Fabric& fabric) {
  if (fabric.grids.empty()) return 0;
  const UvGrid& last = fabric.grids.back();
  return last.first_cell + static_cast<size_t>(last.size.x) * static_cast<size_t>(last.size.y);
}

UvGrid make_grid(const Chart& chart, const ChartMap& map, double yarn_radius, double patches_per_tile,
                 double patches_per_cell) {
  UvGrid grid;
  const double cells = patches_per_tile / patches_per_cell;
  const dvec2 tile_metres = map.tile_uv * map.metric;
  ivec2 split(1), merge(1);
  if (cells >= 1)
    split = cells_per_tile(cells, tile_metres);
  else
    merge = cells_per_tile(1 / cells, 1.0 / tile_metres);
  const dvec2 margin = (map.half_stitch + 3 * yarn_radius) * map.uv_per_metre;
  for (int axis = 0; axis < 2; ++axis) {
    const int tiles = map.rect.wrap[axis];
    if (tiles > 0) {
      merge[axis] = largest_divisor(tiles, merge[axis]);
      grid.cell_size[axis] = map.tile_uv[axis] * merge[axis] / split[axis];
      grid.size[axis] = grid.wrap[axis] = tiles / merge[axis] * split[axis];
      grid.origin[axis] = map.rect.lo[axis] * map.tile_uv[axis];
    } else {
      const double cell = map.tile_uv[axis] * merge[axis] / split[axis];
      const double lo = std::floor((chart.uv_min[axis] - margin[axis]) / cell);
      const double hi = std::ceil((chart.uv_max[axis] + margin[axis]) / cell);
      grid.cell_size[axis] = cell;
      grid.size[axis] = std::max(1, static_cast<int>(hi - lo));
      grid.origin[axis] = lo * cell;
    }
  }
  return grid;
}

uint32_t cell_of(const UvGrid& grid, dvec2 uv) {
  ivec2 at;
  for (int axis = 0; axis < 2; ++axis) {
    const double x = std::floor((uv[axis] - grid.origin[axis]) / grid.cell_size[axis]);
    const int n = grid.size[axis];
    if (grid.wrap[axis] > 0)
      at[axis] = std::min(n - 1, static_cast<int>(x - n * std::floor(x / n)));
    else
      at[axis] = static_cast<int>(std::clamp(x, 0.0, n - 1.0));
  }
  return grid.first_cell + static_cast<uint32_t>(at.x) +
         static_cast<uint32_t>(grid.size.x) * static_cast<uint32_t>(at.y);
}

void for_each_cell(const UvGrid& grid, dvec2 lo, dvec2 hi, const std::function<void(uint32_t, dvec2)>& visit) {
  const dvec2 a = glm::floor((lo - grid.origin) / grid.cell_size), b = glm::floor((hi - grid.origin) / grid.cell_size);
  int64_t first[2], last[2];
  for (int axis = 0; axis < 2; ++axis) {
    const double n = grid.size[axis];
    first[axis] = static_cast<int64_t>(grid.wrap[axis] > 0 ? a[axis] : std::clamp(a[axis], 0.0, n - 1));
    last[axis] = static_cast<int64_t>(grid.wrap[axis] > 0 ? b[axis] : std::clamp(b[axis], 0.0, n - 1));
  }
  const auto column = [](int64_t i, int n) { return static_cast<uint32_t>((i % n + n) % n); };
  for (int64_t y = first[1]; y <= last[1]; ++y)
    for (int64_t x = first[0]; x <= last[0]; ++x)
      visit(grid.first_cell + column(x, grid.size.x) + static_cast<uint32_t>(grid.size.x) * column(y, grid.size.y),
            grid.origin + dvec2(static_cast<double>(x), static_cast<double>(y)) * grid.cell_size);
}

Csr list_triangles(const Fabric& fabric, const std::vector<bool>& knitted) {
  return compress(cell_count(fabric), [&](auto&& emit) {
    for (size_t c = 0; c < fabric.charts.size(); ++c) {
      if (!knitted[c]) continue;
      const UvGrid& grid = fabric.grids[c];
      const dvec2 slack = 1e-9 * grid.cell_size;
      for (const uint32_t t : fabric.charts[c].triangles) {
        const auto& uv = fabric.mesh.uv[t];
        if (uv_area2(uv) == 0) continue;
        const dvec2 lo = glm::min(uv[0], glm::min(uv[1], uv[2])), hi = glm::max(uv[0], glm::max(uv[1], uv[2]));
        for_each_cell(grid, lo - slack, hi + slack, [&](uint32_t cell, dvec2 at) {
          if (!separated(uv, at - slack, at + grid.cell_size + slack)) emit(cell, t);
        });
      }
    }
  });
}

Csr list_segments(const Fabric& fabric, const std::vector<dvec2>& uv) {
  return compress(cell_count(fabric), [&](auto&& emit) {
    for (const PlyRun& run : fabric.runs) {
      const UvGrid& grid = fabric.grids[run.chart];
      const dvec2 radius = double(run.radius) * fabric.uv_per_metre[run.chart];
      const uint32_t begin = run.ghost_ends ? 1 : 0, end = run.count - (run.ghost_ends ? 2 : 1);
      for (uint32_t p = 0; p < run.plies; ++p)
        for (uint32_t k = begin; k < end; ++k) {
          const uint32_t segment = run.first_vertex + p * run.count + k;
          const dvec2 a = uv[segment], b = uv[segment + 1];
          for_each_cell(grid, glm::min(a, b) - radius, glm::max(a, b) + radius,
                        [&](uint32_t cell, dvec2) { emit(cell, segment); });
        }
    }
  });
}

}  // namespace wale
