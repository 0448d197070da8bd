#include "geom/fabric_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geom/error.h"
#include "geom/fibre_bundle.h"
#include "geom/mesh_edges.h"

namespace wale {
namespace {

constexpr double kMaxTilesAcross = 1e6;  ///< keeps instance numbers far inside 32 bits

void check_spec(const Pattern& pattern, const FabricSpec& spec) {
  const auto positive = [&](const char* key, double value) {
    if (!(value > 0) || !std::isfinite(value))
      user_error("fabric '{}': {} is {}; give a number above 0", spec.name, key, value);
  };
  if (spec.plies < 1 || spec.plies > 8) user_error("fabric '{}': {} plies; give 1 to 8", spec.name, spec.plies);
  if (!std::isfinite(spec.twist_pitch) || (spec.twist_pitch != 0 && std::abs(spec.twist_pitch) < 2))
    user_error("fabric '{}': twist pitch {} yarn radii per turn cannot be spun; give 0 (none), or at least 2 in size",
               spec.name, spec.twist_pitch);
  positive("thickness", spec.thickness);
  check_flyaways(spec.flyaways, spec.name.c_str());
  positive("tolerance", spec.tolerance);
  if (!(spec.ply_radius >= 0) || !std::isfinite(spec.ply_radius))
    user_error("fabric '{}': ply radius {}; give metres, or 0 to fill the yarn", spec.name, spec.ply_radius);
  if (!std::isfinite(spec.height_offset))
    user_error("fabric '{}': height offset is not finite; give metres", spec.name);
  if (!(spec.patches_per_cell >= 1) || !(spec.patches_per_cell <= 1e6))
    user_error("fabric '{}': {} patches per cell; give 1 to 1000000", spec.name, spec.patches_per_cell);
  if (pattern.curves.empty()) user_error("fabric '{}': pattern '{}' has no curves", spec.name, pattern.name);
  if (spec.strain == LoopStrain::relaxed && pattern.strains.empty())
    user_error(
        "fabric '{}': pattern '{}' has no table of strains to relax by; give a tile with one, or strain \"affine\"",
        spec.name, pattern.name);
  positive("the pattern's period along x", pattern.period.x);
  positive("the pattern's period along y", pattern.period.y);
  positive("the pattern's yarn radius", pattern.yarn_radius);

  using Kind = FabricScale::Kind;
  if (spec.scale.kind == Kind::repeats) {
    positive("repeats along u", spec.scale.repeats.x);
    positive("repeats along v", spec.scale.repeats.y);
  }
  if (spec.scale.kind == Kind::gauge) {
    const dvec2 gauge = spec.scale.gauge;
    if (!(gauge.x >= 0 && gauge.y >= 0 && gauge.x + gauge.y > 0 && std::isfinite(gauge.x + gauge.y)))
      user_error("fabric '{}': gauge {} x {} is not usable; give wales or courses per metre above 0", spec.name,
                 gauge.x, gauge.y);
    if ((gauge.x > 0 && pattern.stitches.x < 1) || (gauge.y > 0 && pattern.stitches.y < 1))
      user_error("fabric '{}': pattern '{}' does not say how many stitches it has; give 'stitches', or use repeats",
                 spec.name, pattern.name);
  }
}

/// UV size of one tile in a chart before joins are considered.
dvec2 wanted_tile_uv(const Pattern& pattern, const FabricScale& scale, dvec2 metres_per_uv) {
  if (scale.kind == FabricScale::Kind::repeats) return 1.0 / scale.repeats;
  if (scale.kind == FabricScale::Kind::uv_metres) return pattern.period;
  dvec2 tile(0);
  if (scale.gauge.x > 0) tile.x = pattern.stitches.x / scale.gauge.x;
  if (scale.gauge.y > 0) tile.y = pattern.stitches.y / scale.gauge.y;
  if (tile.x == 0) tile.x = tile.y * pattern.period.x / pattern.period.y;
  if (tile.y == 0) tile.y = tile.x * pattern.period.y / pattern.period.x;
  return tile / metres_per_uv;
}

/// Area of a chart in UV and in cloth metres.
double chart_uv_area(const BaseMesh& mesh, const Chart& chart) {
  double area2 = 0;
  for (const uint32_t t : chart.triangles) area2 += std::abs(uv_area2(mesh.uv[t]));
  return 0.5 * area2;
}

/// A chart drawn out to a line in space, but for rounding.
bool has_area(const BaseMesh& mesh, const Chart& chart) {
  dvec3 lo(INFINITY), hi(-INFINITY);
  double area = 0;
  for (const uint32_t t : chart.triangles) {
    const auto& corner = mesh.triangle[t];
    const dvec3 a = mesh.position[corner[0]], b = mesh.position[corner[1]], c = mesh.position[corner[2]];
    area += 0.5 * glm::length(glm::cross(b - a, c - a));
    lo = glm::min(lo, glm::min(a, glm::min(b, c)));
    hi = glm::max(hi, glm::max(a, glm::max(b, c)));
  }
  return area > 1e-12 * glm::dot(hi - lo, hi - lo);
}

/// Tiles that cover the chart; along a join exactly one turn of them.
void lay_tiles(const Chart& chart, const FabricSpec& spec, ChartMap& map, ivec2& snapped) {
  dvec2 join(0);
  for (const dvec2 t : chart.joins) join += t;
  for (int axis = 0; axis < 2; ++axis) {
    const double across = std::max((chart.uv_max - chart.uv_min)[axis], join[axis]) / map.tile_uv[axis];
    const double far = std::max(std::abs(chart.uv_min[axis]), std::abs(chart.uv_max[axis])) / map.tile_uv[axis];
    if (!(across < kMaxTilesAcross) || !(far < 1e9))
      user_error("fabric '{}': {:.3g} tiles across one chart; give a scale with at most {:.0f}", spec.name,
                 std::max(across, far), kMaxTilesAcross);
    if (join[axis] > 0) {
      snapped[axis] = std::max(1, static_cast<int>(std::lround(join[axis] / map.tile_uv[axis])));
      map.tile_uv[axis] = join[axis] / snapped[axis];
      map.rect.lo[axis] = static_cast<int>(std::floor(chart.uv_min[axis] / map.tile_uv[axis]));
      map.rect.hi[axis] = map.rect.lo[axis] + snapped[axis];
      map.rect.wrap[axis] = snapped[axis];
    } else {
      map.rect.lo[axis] = static_cast<int>(std::floor(chart.uv_min[axis] / map.tile_uv[axis])) - 1;
      map.rect.hi[axis] = static_cast<int>(std::ceil(chart.uv_max[axis] / map.tile_uv[axis])) + 1;
      map.rect.wrap[axis] = 0;
    }
  }
}

void set_ply_radius(const FabricSpec& spec, FabricMap& map) {
  if (spec.ply_radius > map.yarn_radius)
    user_error("fabric '{}': ply radius {:.4g} m does not fit into a yarn of radius {:.4g} m; give at most that, or 0",
               spec.name, spec.ply_radius, map.yarn_radius);
  map.yarn.ply_radius = spec.ply_radius;
  map.yarn.helix_radius = spec.plies == 1 ? 0 : map.yarn_radius - spec.ply_radius;
}

void set_yarn(const Pattern& pattern, const FabricSpec& spec, double z_scale, FabricMap& map) {
  map.yarn_radius = pattern.yarn_radius * z_scale * spec.thickness;
  map.yarn.plies = spec.plies;
  map.yarn.tolerance = spec.tolerance;
  map.yarn.places = spec.places;
  map.yarn.strains = spec.strain == LoopStrain::relaxed;
  map.yarn.twist = spec.twist_pitch == 0 ? 0 : 1 / (spec.twist_pitch * map.yarn_radius);
  fill_yarn(map.yarn, map.yarn_radius);
  if (spec.ply_radius > 0) set_ply_radius(spec, map);
  if (spec.flyaways.any())
    map.flyaway_radius =
        spec.flyaways.radius > 0 ? spec.flyaways.radius : fibre_radius(spec.fibres) * map.yarn.ply_radius;
  if (spec.detail != Detail::fibres) return;
  // Everything is sampled as finely as the fibres need it: samples of the ply are samples of its fibres.
  map.yarn.tolerance = std::min(spec.tolerance, kFibreTolerance * fibre_radius(spec.fibres));
  map.yarn.winding = winding_curvature(spec.fibres, map.yarn.ply_radius);
}

}  // namespace

FabricMap map_fabric(const BaseMesh& mesh, const std::vector<Chart>& charts, const Pattern& pattern,
                     const FabricSpec& spec) {
  check_spec(pattern, spec);
  FabricMap map;
  map.charts.resize(charts.size());
  double total_area = 0;
  bool tile_fits = false;
  dvec2 largest_cloth(0), wanted(0);
  for (size_t c = 0; c < charts.size(); ++c) {
    ChartMap& chart = map.charts[c];
    const double uv_area = chart_uv_area(mesh, charts[c]);
    const dvec2 metres = charts[c].metres_per_uv;
    chart.knitted = uv_area > 0 && metres.x > 0 && metres.y > 0 && has_area(mesh, charts[c]);
    if (!chart.knitted) continue;
    chart.metric = spec.scale.kind == FabricScale::Kind::uv_metres ? dvec2(1) : metres;
    chart.uv_per_metre = 1.0 / chart.metric;
    chart.tile_uv = wanted_tile_uv(pattern, spec.scale, metres);
    const double area = uv_area * chart.metric.x * chart.metric.y;
    total_area += area;
    map.tile_metres += area * chart.tile_uv * chart.metric;
    const dvec2 extent = charts[c].uv_max - charts[c].uv_min;
    tile_fits = tile_fits || (chart.tile_uv.x <= 1.000001 * extent.x && chart.tile_uv.y <= 1.000001 * extent.y);
    if (extent.x * extent.y * chart.metric.x * chart.metric.y > largest_cloth.x * largest_cloth.y) {
      largest_cloth = extent * chart.metric;
      wanted = chart.tile_uv * chart.metric;
    }
  }
  if (!(total_area > 0))
    user_error("fabric '{}': no chart has an area in space and in UV; unwrap the mesh again", spec.name);
  if (!tile_fits)
    user_error(
        "fabric '{}': a tile of {:.4g} x {:.4g} m is larger than the cloth of {:.4g} x {:.4g} m; make it at least "
        "{:.3g} "
        "times finer",
        spec.name, wanted.x, wanted.y, largest_cloth.x, largest_cloth.y,
        std::max(wanted.x / largest_cloth.x, wanted.y / largest_cloth.y));

  map.tile_metres /= total_area;
  const dvec2 stitches(std::max(1, pattern.stitches.x), std::max(1, pattern.stitches.y));
  map.stitch_metres = map.tile_metres / stitches;
  // Through the cloth, and for radii, the geometric mean of the two scales: the yarn stays round.
  const double z_scale = std::sqrt(map.tile_metres.x / pattern.period.x * (map.tile_metres.y / pattern.period.y));
  set_yarn(pattern, spec, z_scale, map);

  for (size_t c = 0; c < charts.size(); ++c) {
    ChartMap& chart = map.charts[c];
    if (!chart.knitted) continue;
    ivec2 snapped(0);
    lay_tiles(charts[c], spec, chart, snapped);
    if (!charts[c].joins.empty()) map.snapped.push_back(snapped);
    const dvec2 tile = chart.tile_uv * chart.metric;
    chart.scale = dvec3(tile / pattern.period, z_scale);
    chart.stitch = tile / stitches;
    chart.stitches_per_tile = ivec2(stitches);
    chart.half_stitch = 0.5 * std::min(tile.x / stitches.x, tile.y / stitches.y);
  }
  return map;
}

size_t estimate_segments(const BaseMesh& mesh, const Pattern& pattern, const FabricSpec& spec) {
  require_uv(mesh);
  const std::vector<Chart> charts = find_charts(mesh);
  const FabricMap map = map_fabric(mesh, charts, pattern, spec);
  const PartnerMap partners = match_partners(pattern);
  double segments = 0;
  for (size_t c = 0; c < charts.size(); ++c) {
    const ChartMap& chart = map.charts[c];
    if (!chart.knitted) continue;
    // Tiles by area, and the strip of half a stitch round the chart's box.
    const dvec2 extent = charts[c].uv_max - charts[c].uv_min;
    const dvec2 margin = chart.half_stitch * chart.uv_per_metre * (1.0 - glm::sign(dvec2(chart.rect.wrap)));
    const double strip = 2 * (extent.x * margin.y + extent.y * margin.x);
    const double tiles = (chart_uv_area(mesh, charts[c]) + strip) / (chart.tile_uv.x * chart.tile_uv.y);
    const int curves = spec.plies * (spec.detail == Detail::fibres ? spec.fibres.fibres : 1);
    segments += tiles * static_cast<double>(samples_per_tile(pattern, partners, map.yarn, chart.scale)) * curves;
    if (!spec.flyaways.any()) continue;
    const double wound = std::hypot(1, 2 * std::numbers::pi * map.yarn.twist * map.yarn.helix_radius);
    const double ply_metres = tiles * spec.plies * wound * yarn_per_tile(pattern, partners, map.yarn, chart.scale);
    PlyPiece piece;
    piece.radius = map.yarn.ply_radius;
    piece.twist = spec.fibres.twist;
    piece.migrations = spec.fibres.migration_rate;
    segments += ply_metres * flyaway_segments_per_metre(spec.flyaways, piece, kFibreTolerance * map.flyaway_radius);
  }
  return static_cast<size_t>(std::min(segments, 1e18));
}

}  // namespace wale
