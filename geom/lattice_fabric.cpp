#include "geom/lattice_fabric.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "geom/error.h"
#include "geom/fabric_map.h"
#include "shared/wale_types.h"

namespace wale {

std::string lattice_obstacle(const BaseMesh& mesh, const Pattern& pattern, const FabricSpec& spec) {
  if (spec.detail == Detail::fibres) return "its fibres are explicit";
  if (spec.flyaways.any()) return "it has flyaways";
  if (spec.strain == LoopStrain::relaxed) return "its strain is \"relaxed\", which gives every tile its own shape";
  if (spec.places) return "its colours vary over the cloth";
  if (std::string why = tile_knit_obstacle(pattern, match_partners(pattern), spec.plies); !why.empty()) return why;
  for (const Chart& chart : find_charts(mesh))
    if (std::string why = lattice_obstacle(mesh, chart); !why.empty()) return why;
  return {};
}

Fabric knit_lattice(BaseMesh mesh, const Pattern& pattern, const FabricSpec& spec) {
  require_uv(mesh);
  if (const std::string why = lattice_obstacle(mesh, pattern, spec); !why.empty())
    user_error("fabric '{}': a lattice cannot hold it, as {}; give storage \"stored\" and no lattice", spec.name, why);
  Fabric fabric;
  fabric.name = spec.name;
  fabric.plies = spec.plies;
  fabric.mesh = std::move(mesh);
  fabric.charts = find_charts(fabric.mesh);
  fabric.fibre_twist = spec.fibres.twist;
  fabric.procedural = spec.storage != Storage::stored;
  const FabricMap map = map_fabric(fabric.mesh, fabric.charts, pattern, spec);
  const PartnerMap partners = match_partners(pattern);
  fabric.ply_radius = map.yarn.ply_radius;
  fabric.yarn_radius = map.yarn_radius;
  const int cells = std::max(1, spec.lattice);
  Fabric::Report& report = fabric.report;
  double area = 0;
  for (size_t c = 0; c < fabric.charts.size(); ++c) {
    const Chart& chart = fabric.charts[c];
    const ChartMap& chart_map = map.charts[c];
    fabric.uv_per_metre.push_back(chart_map.uv_per_metre);
    if (!chart_map.knitted) continue;
    dvec2 join(0);
    for (const dvec2 t : chart.joins) join += t;
    ivec2 wrap(0), tiles(1);
    dvec2 tile_uv(1), origin = chart.uv_min;
    for (int axis = 0; axis < 2; ++axis) {
      wrap[axis] = join[axis] > 0;
      const double across = wrap[axis] ? join[axis] : (chart.uv_max - chart.uv_min)[axis];
      tiles[axis] = std::max(1, int(std::lround(across / chart_map.tile_uv[axis])));
      tile_uv[axis] = across / tiles[axis];
    }
    const dvec2 tile = tile_uv * chart_map.metric;
    const dvec3 scale(tile / pattern.period, chart_map.scale.z);
    LatticeChart made;
    made.tile = knit_tile(pattern, partners, map.yarn, scale, cells, spec.height_offset);
    // A leaf number holds a vertex and a patch of the tile (wale_types.h).
    size_t patches = 0;
    for (const TileYarn& yarn : made.tile.yarns) {
      const uint32_t most = W_LEAF_LANES / uint32_t(spec.plies);
      patches += (yarn.samples + most - 1) / most;
    }
    made.lattice = sample_lattice(fabric.mesh, chart, origin, tile_uv, tiles, wrap, cells, made.tile.reach_lo,
                                  made.tile.reach_hi, W_LEAF_PROCEDURAL / std::bit_ceil(std::max<size_t>(patches, 1)));
    for (const TileYarn& yarn : made.tile.yarns) {
      const size_t lines = size_t(tiles[1 - yarn.axis]), along = size_t(tiles[yarn.axis]);
      report.full_yarns += lines;
      report.runs += lines;
      report.plies += lines * size_t(spec.plies);
      report.segments += lines * along * yarn.samples * size_t(spec.plies);
    }
    const double share = tile.x * tile.y * tiles.x * tiles.y;
    area += share;
    report.tile_metres += share * tile;
    report.snapped_repeats.push_back(tiles);
    report.mirrored = report.mirrored || chart.mirrored;
    fabric.lattice.push_back(std::move(made));
  }
  report.worst_partner_distance = partners.worst_distance;
  if (area > 0) report.tile_metres /= area;
  report.stitch_metres = map.stitch_metres * report.tile_metres / map.tile_metres;
  return fabric;
}

}  // namespace wale
