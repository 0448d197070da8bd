#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "geom/flat_knit.h"

namespace wale {

/// One vertex of a ply as a fixed combination of lattice vertices (geom/lattice.h). It lies in one lattice cell; W,
/// with the corners (0,0), (1,0), (0,1), (1,1) of that cell and their positions P and normals N:
///   W = sum w P + h N,   carried frame normal = sum a P + b N
/// with w the bilinear weights, h = w z, a = the change of w along (nx, ny), b = a z + w nz. Lengths in metres.
struct TileVertex {
  ivec2 cell{0, 0};  ///< lattice cells from the tile's corner
  float w[4] = {}, h[4] = {}, a[4] = {}, b[4] = {};
  double length = 0;  ///< metres of ply from the start of the tile's piece
};

/// One pass of a tile yarn through its tile. A line of tiles along `axis` joins the passes to one yarn.
struct TileYarn {
  int axis = 0;                    ///< 0: it goes on in the next column, 1: in the next row
  uint32_t samples = 0;            ///< segments of one ply in one pass
  std::vector<TileVertex> vertex;  ///< [ply * (samples + 3) + 1 + k], k = -1 .. samples + 1: one more at either side
  std::vector<double> lap;         ///< per ply: metres of ply in one pass
  double twist_change = 0;         ///< turns per metre of yarn, added so that a pass makes whole turns
  /// Vertex k of a ply, -1 .. samples + 1.
  const TileVertex& at(uint32_t ply, int k) const { return vertex[size_t(ply) * (samples + 3) + size_t(k + 1)]; }
};

/// A tile whose plies join their own copies: the plies of a regular cloth, once.
struct TileKnit {
  int plies = 0, cells = 1;  ///< cells: of the lattice, along each side of the tile
  double ply_radius = 0;     ///< metres
  std::vector<TileYarn> yarns;
  ivec2 reach_lo{0, 0},
      reach_hi{0, 0};  ///< lattice cells that its vertices lie in, from the tile's corner; hi included
  double highest = 0;  ///< metres: largest |z|
};

/// Why a yarn of `plies` in this pattern cannot repeat with its tile; empty when it can. Leaves of at most 32 points
/// hold 1 to 6 plies; every yarn must go on in the next column or row.
std::string tile_knit_obstacle(const Pattern& pattern, const PartnerMap& partners, int plies);

/// Knits one tile. The twist is changed to the nearest whole number of turns in one pass, frames close over one pass.
/// scale: pattern metres -> cloth metres; height: added to every z.
TileKnit knit_tile(const Pattern& pattern, const PartnerMap& partners, const YarnSpec& spec, dvec3 scale, int cells,
                   double height);

}  // namespace wale
