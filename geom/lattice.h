#pragma once
#include <string>
#include <vector>

#include "geom/base_mesh.h"
#include "geom/charts.h"
#include "geom/tile_knit.h"

namespace wale {

/// How the warp of a regular cloth is held: base positions and unit normals at the corners of a grid aligned with the
/// tile, W = P + z N with P and N bilinear in each of its cells (KNIT21 section 3.1). Columns and rows go on past the
/// chart as far as plies do; where the chart is joined to itself they are copies, bit by bit.
struct Lattice {
  ivec2 tiles{1, 1};            ///< columns and rows of whole tiles that cover the chart
  ivec2 wrap{0, 0};             ///< 1 where the last tile joins the first
  int cells = 1;                ///< along each side of a tile
  ivec2 margin{0, 0};           ///< cells before the first tile
  ivec2 size{0, 0};             ///< vertices
  std::vector<dvec3> position;  ///< metres; vertex (x, y) at x + size.x * y
  std::vector<dvec3> normal;    ///< unit
  /// Number of the vertex at the corner of a tile.
  uint32_t corner(ivec2 tile) const {
    return uint32_t(tile.x * cells + margin.x) + uint32_t(size.x) * uint32_t(tile.y * cells + margin.y);
  }
};

/// One chart of a fabric as lattice and tile.
struct LatticeChart {
  Lattice lattice;
  TileKnit tile;
};

/// Why a chart cannot be covered by whole tiles; empty when it can: it must be a rectangle in UV, covered once.
std::string lattice_obstacle(const BaseMesh& mesh, const Chart& chart);

/// Samples the mesh at the corners of `tiles` x `cells` cells from `origin` on, tile_uv a tile, and `reach_lo` to
/// `reach_hi` cells of one tile past its corners. Throws a user error when that makes more than `most` vertices.
Lattice sample_lattice(const BaseMesh& mesh, const Chart& chart, dvec2 origin, dvec2 tile_uv, ivec2 tiles, ivec2 wrap,
                       int cells, ivec2 reach_lo, ivec2 reach_hi, size_t most);

}  // namespace wale
