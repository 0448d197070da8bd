#include "geom/fabric.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <thread>

#include "geom/error.h"
#include "geom/fabric_map.h"
#include "geom/fibre_bundle.h"
#include "geom/uv_grid.h"
#include "geom/yarn_cut.h"
#include "shared/wale_types.h"

namespace wale {
namespace {

/// Above this a fabric's vertex numbers (32 bits) and the host's memory both give in.
constexpr size_t kMaxSegments = 1'000'000'000;

/// Cuts every run into full patches, owned by the cell under their middle.
void make_patches(Fabric& fabric, const std::vector<dvec2>& uv) {
  for (uint32_t r = 0; r < fabric.runs.size(); ++r) {
    const PlyRun& run = fabric.runs[r];
    const uint32_t most = W_LEAF_LANES / run.plies;
    const uint32_t begin = run.ghost_ends ? 1 : 0, end = run.count - (run.ghost_ends ? 2 : 1);
    for (uint32_t k = begin; k < end; k += most) {
      Patch patch{r, k, std::min(most, end - k), 0};
      dvec2 middle(0);
      for (uint32_t p = 0; p < run.plies; ++p)
        middle += uv[run.first_vertex + p * run.count + k + patch.intervals / 2] / static_cast<double>(run.plies);
      patch.cell = cell_of(fabric.grids[run.chart], middle);
      fabric.patches.push_back(patch);
    }
  }
  std::stable_sort(fabric.patches.begin(), fabric.patches.end(),
                   [](const Patch& a, const Patch& b) { return a.cell < b.cell; });
}

/// Leaves that one sample interval of a yarn takes.
double leaves_per_sample(const FabricSpec& spec) {
  if (spec.detail != Detail::fibres) return 1.0 / (W_LEAF_LANES / spec.plies);
  const double groups = std::ceil(double(spec.fibres.fibres) / kFibreGroup);
  return spec.plies * groups / (W_LEAF_LANES / kFibreGroup);
}

}  // namespace

Fabric knit_fabric(BaseMesh mesh, const Pattern& pattern, const FabricSpec& spec, unsigned threads) {
  if (threads == 0) threads = std::max(1u, std::thread::hardware_concurrency());
  require_uv(mesh);
  const size_t expected = estimate_segments(mesh, pattern, spec);
  if (expected > kMaxSegments)
    user_error("fabric '{}': about {:.3g} ply segments; give a coarser scale, at most {:.3g}", spec.name,
               static_cast<double>(expected), static_cast<double>(kMaxSegments));

  Fabric fabric;
  fabric.name = spec.name;
  fabric.plies = spec.plies;
  fabric.mesh = std::move(mesh);
  fabric.charts = find_charts(fabric.mesh);
  const FabricMap map = map_fabric(fabric.mesh, fabric.charts, pattern, spec);
  const PartnerMap partners = match_partners(pattern);
  fabric.ply_radius = map.yarn.ply_radius;
  fabric.yarn_radius = map.yarn_radius;
  fabric.flyaway_radius = map.flyaway_radius;
  std::unique_ptr<FibreBundle> bundle;
  if (spec.detail == Detail::fibres) {
    bundle = std::make_unique<FibreBundle>(spec.fibres, fabric.ply_radius);
    fabric.fibre_radius = bundle->fibre_radius();
  }
  fabric.chart_of_triangle.resize(fabric.mesh.triangle.size());
  fabric.anchors.reserve(expected + expected / 8);

  std::vector<dvec2> uv;  // per vertex, in the flat knit
  uv.reserve(expected + expected / 8);
  std::vector<bool> knitted;
  size_t cells = 0;
  for (uint32_t c = 0; c < fabric.charts.size(); ++c) {
    const Chart& chart = fabric.charts[c];
    const ChartMap& chart_map = map.charts[c];
    for (const uint32_t t : chart.triangles) fabric.chart_of_triangle[t] = c;
    fabric.uv_per_metre.push_back(chart_map.uv_per_metre);
    knitted.push_back(chart_map.knitted);
    UvGrid grid;
    if (chart_map.knitted) {
      const long samples = samples_per_tile(pattern, partners, map.yarn, chart_map.scale);
      const double patches_per_tile = static_cast<double>(samples) * leaves_per_sample(spec);
      grid = make_grid(chart, chart_map, map.yarn_radius, patches_per_tile, spec.patches_per_cell);
      fabric.report.mirrored = fabric.report.mirrored || chart.mirrored;
    }
    grid.first_cell = static_cast<uint32_t>(cells);
    cells += static_cast<size_t>(grid.size.x) * static_cast<size_t>(grid.size.y);
    if (cells > kMaxSegments)
      user_error("fabric '{}': {:.3g} UV cells; give more patches per cell, or a coarser scale", spec.name,
                 static_cast<double>(cells));
    fabric.grids.push_back(grid);
    if (!chart_map.knitted) continue;
    const FlatKnit knit(pattern, partners, map.yarn, chart_map.scale, chart_map.rect);
    cut_yarns(fabric, {fabric, c, chart_map, spec, bundle.get(), map.flyaway_radius,
                       spec.strain == LoopStrain::relaxed ? &pattern.strains : nullptr}, knit, threads, uv);
  }
  if (fabric.runs.empty()) user_error("fabric '{}': no yarn lies on the cloth; give a finer scale", spec.name);

  make_patches(fabric, uv);
  if (spec.cell_lists) {
    fabric.cell_triangles = list_triangles(fabric, knitted);
    fabric.cell_segments = list_segments(fabric, uv);
  }

  Fabric::Report& report = fabric.report;
  report.runs = fabric.runs.size();
  for (const PlyRun& run : fabric.runs) {
    (run.kind == PlyRun::Kind::ply ? report.plies : report.fibres) += run.plies;
    report.segments += static_cast<size_t>(run.plies) * (run.count - (run.ghost_ends ? 3 : 1));
  }
  report.vertices = fabric.anchors.size();
  report.worst_partner_distance = partners.worst_distance;
  report.snapped_repeats = map.snapped;
  report.tile_metres = map.tile_metres;
  report.stitch_metres = map.stitch_metres;
  return fabric;
}

}  // namespace wale
