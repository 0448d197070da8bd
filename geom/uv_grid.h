#pragma once
#include <functional>

#include "geom/fabric.h"
#include "geom/fabric_map.h"

namespace wale {

/// A grid over the chart's box and margin with about `patches_per_cell` patches in a cell; cells are whole fractions or
/// whole multiples of the tile. `first_cell` is left to the caller.
UvGrid make_grid(const Chart& chart, const ChartMap& map, double yarn_radius, double patches_per_tile,
                 double patches_per_cell);

/// Global number of the cell that holds uv: wrapped along joins, else clamped into the grid.
uint32_t cell_of(const UvGrid& grid, dvec2 uv);

/// Cells of all charts.
size_t cell_count(const Fabric& fabric);

/// Calls visit(cell) for every cell that the UV box lo..hi touches; a cell may come twice where the grid wraps.
void for_each_cell(const UvGrid& grid, dvec2 lo, dvec2 hi,
                   const std::function<void(uint32_t cell, dvec2 cell_lo)>& visit);

/// Triangles per cell whose UV polygon overlaps it (conservative by rounding only).
Csr list_triangles(const Fabric& fabric, const std::vector<bool>& knitted);

/// Segments per cell that their flat footprint, a box around the segment and its radius, touches. `uv` per vertex.
Csr list_segments(const Fabric& fabric, const std::vector<dvec2>& uv);

}  // namespace wale
