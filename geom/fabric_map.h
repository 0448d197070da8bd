#pragma once
#include <vector>

#include "geom/fabric.h"

namespace wale {

/// How the tile lies in one chart.
struct ChartMap {
  bool knitted = false;      ///< false where the chart has no area in UV or in space
  dvec2 uv_per_metre{1, 1};  ///< UV = uv_per_metre * (x, y)
  dvec2 metric{1, 1};        ///< its inverse: cloth metres per UV
  dvec2 tile_uv{1, 1};       ///< size of one tile
  dvec3 scale{1, 1, 1};      ///< pattern metres -> cloth metres
  InstanceRect rect;         ///< tiles that cover the chart and a margin of one tile
  double half_stitch = 0;    ///< metres: how far yarns run past a border
  dvec2 stitch{1, 1};        ///< size of a stitch, metres
  ivec2 stitches_per_tile{1, 1};
};

/// The fabric's scale, worked out from one of its three keys.
struct FabricMap {
  YarnSpec yarn;
  double yarn_radius = 0;     ///< metres in the cloth, thickness included
  double flyaway_radius = 0;  ///< metres; 0 without flyaways
  dvec2 tile_metres{0, 0};    ///< mean over the charts, by area
  dvec2 stitch_metres{0, 0};
  std::vector<ChartMap> charts;
  std::vector<ivec2> snapped;  ///< per joined chart: whole tiles across the joins (0 where not joined)
};

/// Throws a user error, naming the fabric, for values out of range and for tiles larger than the cloth.
FabricMap map_fabric(const BaseMesh& mesh, const std::vector<Chart>& charts, const Pattern& pattern,
                     const FabricSpec& spec);

}  // namespace wale
