// Fabrics assembled on the bundled base meshes: nothing lost, nothing twice, closed where the cloth is closed.
#include "geom/fabric.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <set>
#include <tuple>

#include "geom/base_mesh_generators.h"
#include "geom/error.h"
#include "geom/mesh_edges.h"
#include "geom/stored_length.h"
#include "geom/uv_grid.h"
#include "geom/warp.h"
#include "shared/wale_types.h"

namespace wale {
namespace {

FabricSpec metric_spec() {
  FabricSpec spec;
  spec.name = "test";
  spec.scale.kind = FabricScale::Kind::uv_metres;
  return spec;
}

Fabric tube(double height = 0.03) {
  return knit_fabric(make_tube(0.01, height, 48, 12), stockinette_pattern(), metric_spec());
}

dvec3 place(const Fabric& fabric, const Anchor& a) {
  return warp_point(fabric.mesh, {a.triangle, a.b1, a.b2, 0}, a.height);
}

/// UV of an anchor inside its triangle's plane, so in the chart's own period.
dvec2 uv_of(const Fabric& fabric, const Anchor& a) {
  const auto& t = fabric.mesh.uv[a.triangle];
  return (1.0 - a.b1 - a.b2) * t[0] + double(a.b1) * t[1] + double(a.b2) * t[2];
}

/// Segment ids that a fabric must trace: every interval of every run, without the ghosts.
std::vector<uint32_t> all_segments(const Fabric& fabric) {
  std::vector<uint32_t> ids;
  for (const PlyRun& run : fabric.runs)
    for (uint32_t p = 0; p < run.plies; ++p)
      for (uint32_t k = run.ghost_ends ? 1 : 0; k + (run.ghost_ends ? 2 : 1) < run.count; ++k)
        ids.push_back(run.first_vertex + p * run.count + k);
  return ids;
}

void expect_sound(const Fabric& fabric) {
  const auto ids = all_segments(fabric);
  EXPECT_EQ(fabric.report.segments, ids.size());
  EXPECT_EQ(fabric.report.vertices, fabric.anchors.size());
  EXPECT_EQ(fabric.report.runs, fabric.runs.size());

  uint32_t next = 0;  // runs fill the vertices without gap
  for (const PlyRun& run : fabric.runs) {
    EXPECT_EQ(run.first_vertex, next);
    EXPECT_GE(run.count, run.ghost_ends ? 4u : 2u);
    next += run.count * run.plies;
    const uint32_t end = run.first_vertex + run.count * run.plies;
    for (uint32_t v = run.first_vertex; v < end; ++v) {
      const Anchor& a = fabric.anchors[v];
      ASSERT_LT(a.triangle, fabric.mesh.triangle.size());
      ASSERT_EQ(fabric.chart_of_triangle[a.triangle], run.chart);
      ASSERT_TRUE(std::isfinite(a.b1 + a.b2 + a.height + a.length));
      ASSERT_NEAR(a.nx * a.nx + a.ny * a.ny + a.nz * a.nz, 1, 1e-5);
    }
  }
  EXPECT_EQ(next, fabric.anchors.size());

  std::vector<uint32_t> traced;
  for (size_t i = 0; i < fabric.patches.size(); ++i) {
    const Patch& patch = fabric.patches[i];
    EXPECT_TRUE(patch.intervals >= 1 && patch.intervals * fabric.runs[patch.run].plies <= W_LEAF_LANES);
    EXPECT_TRUE(i == 0 || fabric.patches[i - 1].cell <= patch.cell);
    EXPECT_LT(patch.cell + 1, fabric.cell_segments.offset.size());
    const PlyRun& run = fabric.runs[patch.run];
    for (uint32_t p = 0; p < run.plies; ++p)
      for (uint32_t k = 0; k < patch.intervals; ++k)
        traced.push_back(run.first_vertex + p * run.count + patch.first + k);
  }
  std::sort(traced.begin(), traced.end());
  EXPECT_TRUE(traced == ids);
}

std::set<uint32_t> row(const Csr& csr, uint32_t r) {
  return {csr.item.begin() + csr.offset[r], csr.item.begin() + csr.offset[r + 1]};
}

template <typename Action>
std::string message(Action&& action) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::user);
    return error.what();
  }
  ADD_FAILURE() << "no error was raised";
  return "";
}

TEST(Fabric, EveryBundledMeshIsSound) {
  const Pattern pattern = stockinette_pattern();
  for (const BaseMesh& mesh :
       {make_swatch(0.03, 0.02, 6, 5), make_tube(0.01, 0.03, 48, 12), make_pillow(0.04, 0.03, 0.01, 16, 14),
        make_beanie(0.02, 0.04, 32, 24), make_draped_square(0.05, 0.01, 30)}) {
    SCOPED_TRACE(mesh.name);
    for (const int plies : {1, 3, 8}) {
      if (plies != 3 && mesh.name != "tube") continue;
      FabricSpec spec = metric_spec();
      spec.plies = plies;
      const Fabric fabric = knit_fabric(mesh, pattern, spec);
      expect_sound(fabric);
      const double estimate = double(estimate_segments(mesh, pattern, spec));
      EXPECT_NEAR(estimate / double(fabric.report.segments), 1, 0.25);
    }
  }
}

TEST(Fabric, FlatSwatchKeepsTheFlatKnit) {
  // On a flat metric sheet the warp is a translation, so neighbours keep their rest distance.
  const Fabric fabric = knit_fabric(make_swatch(0.03, 0.02, 6, 5), stockinette_pattern(), metric_spec());
  double worst = 0;
  for (const PlyRun& run : fabric.runs)
    for (uint32_t k = 0; k + 1 < run.count; ++k) {
      const Anchor &a = fabric.anchors[run.first_vertex + k], &b = fabric.anchors[run.first_vertex + k + 1];
      const double rest = length_between(a.length, b.length, fabric.ply_radius);
      worst = std::max(worst, std::abs(glm::length(place(fabric, b) - place(fabric, a)) / rest - 1));
    }
  EXPECT_LT(worst, 0.02);  // chord against arc, and float lengths
}

TEST(Fabric, YarnsReachHalfAStitchPastTheBorderAndNoFarther) {
  const Fabric fabric = knit_fabric(make_swatch(0.03, 0.02, 6, 5), stockinette_pattern(), metric_spec());
  const double half = 0.5 * std::min(fabric.report.stitch_metres.x, fabric.report.stitch_metres.y);
  double beyond = 0;
  for (const Anchor& a : fabric.anchors) {
    const dvec2 uv = uv_of(fabric, a);
    beyond = std::max({beyond, -uv.x, -uv.y, uv.x - 0.03, uv.y - 0.02});
  }
  EXPECT_GT(beyond, 0.8 * half);
  EXPECT_LT(beyond, half + 1.01 * fabric.yarn_radius);
  EXPECT_GT(fabric.report.samples_extrapolated, 0u);
  EXPECT_GT(fabric.report.samples_outside, 0u);
}

TEST(Fabric, NoSampleOnTheClothIsLost) {
  const Pattern pattern = stockinette_pattern();
  const FabricSpec spec = metric_spec();
  const BaseMesh mesh = make_swatch(0.03, 0.02, 6, 5);
  const Fabric fabric = knit_fabric(mesh, pattern, spec);
  const FabricMap map = map_fabric(mesh, fabric.charts, pattern, spec);
  size_t inside = 0, delivered = 0;
  knit_flat(pattern, match_partners(pattern), map.yarn, map.charts[0].scale, map.charts[0].rect, [&](FlatYarn&& yarn) {
    for (const dvec3& c : yarn.centre) {
      const dvec2 over = glm::max(glm::max(-dvec2(c), dvec2(c) - dvec2(0.03, 0.02)), dvec2(0));
      inside += glm::length(over) <= map.charts[0].half_stitch;
      ++delivered;
    }
  });
  EXPECT_EQ(fabric.anchors.size(), inside * size_t(fabric.plies));
  EXPECT_EQ(fabric.report.samples_outside, delivered - inside);
}

TEST(Fabric, TubeYarnsCloseAndRepeatsSnap) {
  const Fabric fabric = tube();
  ASSERT_EQ(fabric.report.snapped_repeats.size(), 1u);
  const double tiles = 2 * std::numbers::pi * 0.01 / stockinette_pattern().period.x;
  EXPECT_EQ(fabric.report.snapped_repeats[0], ivec2(int(std::lround(tiles)), 0));
  size_t closed = 0;
  double turns = 0;
  for (const PlyRun& run : fabric.runs) {
    if (!run.ghost_ends) continue;
    ++closed;
    for (uint32_t p = 0; p < run.plies; ++p) {
      const Anchor* a = fabric.anchors.data() + run.first_vertex + p * run.count;
      const uint32_t last = run.count - 3;
      for (const auto& [ghost, real] : {std::pair(0u, last), std::pair(last + 1, 1u), std::pair(last + 2, 2u)}) {
        EXPECT_EQ(std::memcmp(&a[ghost], &a[real], offsetof(Anchor, length)), 0);  // all but the length, to the bit
      }
      EXPECT_GT(length_between(a[1].length, a[last + 1].length, fabric.ply_radius), 0);
      EXPECT_NEAR(length_between(a[last + 1].length, a[last + 2].length, fabric.ply_radius),
                  length_between(a[1].length, a[2].length, fabric.ply_radius), 1e-6);
    }
    const Anchor* a = fabric.anchors.data() + run.first_vertex;
    for (uint32_t k = 1; k + 2 < run.count; ++k) {
      const dvec3 from = place(fabric, a[k]), to = place(fabric, a[k + 1]);
      turns += std::atan2(from.x * to.y - from.y * to.x, from.x * to.x + from.y * to.y) / (2 * std::numbers::pi);
    }
  }
  // A course per stitch height on 30 mm of tube, each once round; the outermost are cut by the hem.
  const double courses = 0.03 / fabric.report.stitch_metres.y;
  EXPECT_NEAR(double(closed), courses, 2);
  EXPECT_NEAR(turns, double(closed), 1e-6);
}

TEST(Fabric, NoSegmentOfATubeIsLongAcrossTheSeam) {
  for (const double height : {0.03, 0.0305, 0.031}) {  // hems that cut yarns at different places of the seam
    const Fabric fabric = tube(height);
    double longest = 0, rest = 0;
    for (const uint32_t id : all_segments(fabric)) {
      const Anchor &a = fabric.anchors[id], &b = fabric.anchors[id + 1];
      longest = std::max(longest, glm::length(place(fabric, b) - place(fabric, a)));
      const double between = length_between(a.length, b.length, fabric.ply_radius);
      rest = std::max(rest, between);
      EXPECT_GT(between, 0);
    }
    EXPECT_LT(longest, 1.5 * rest);
  }
}

TEST(Fabric, EverySegmentIsListedInTheCellsOfItsMiddleAndOfItsPatchOnce) {
  for (const BaseMesh& mesh : {make_tube(0.01, 0.03, 48, 12), make_pillow(0.04, 0.03, 0.01, 16, 14)}) {
    const Fabric fabric = knit_fabric(mesh, stockinette_pattern(), metric_spec());
    std::set<uint32_t> listed;
    for (uint32_t cell = 0; cell + 1 < fabric.cell_segments.offset.size(); ++cell) {
      const auto items = row(fabric.cell_segments, cell);
      EXPECT_EQ(items.size(), fabric.cell_segments.offset[cell + 1] - fabric.cell_segments.offset[cell]);
      listed.insert(items.begin(), items.end());
    }
    EXPECT_TRUE(std::vector(listed.begin(), listed.end()) == all_segments(fabric));
    for (const PlyRun& run : fabric.runs)
      for (uint32_t k = run.ghost_ends ? 1 : 0; k + (run.ghost_ends ? 2 : 1) < run.count; k += 3) {
        const uint32_t id = run.first_vertex + k;
        const dvec2 a = uv_of(fabric, fabric.anchors[id]), b = uv_of(fabric, fabric.anchors[id + 1]);
        if (glm::length(b - a) > 0.01) continue;  // ends on the two sides of the seam
        const uint32_t cell = cell_of(fabric.grids[run.chart], 0.5 * (a + b));
        EXPECT_TRUE(row(fabric.cell_segments, cell).count(id)) << id;
      }
  }
}

TEST(Fabric, CellsListTheTriangleOfEveryPointOnTheCloth) {
  const Fabric fabric = knit_fabric(make_beanie(0.02, 0.04, 32, 24), stockinette_pattern(), metric_spec());
  size_t checked = 0;
  for (uint32_t t = 0; t < fabric.mesh.triangle.size(); ++t)
    for (const auto& [b1, b2] :
         {std::pair(0.3, 0.3), std::pair(0.9, 0.05), std::pair(0.05, 0.9), std::pair(0.05, 0.05)}) {
      const auto& uv = fabric.mesh.uv[t];
      const dvec2 p = (1 - b1 - b2) * uv[0] + b1 * uv[1] + b2 * uv[2];
      const uint32_t cell = cell_of(fabric.grids[fabric.chart_of_triangle[t]], p);
      EXPECT_TRUE(row(fabric.cell_triangles, cell).count(t));
      ++checked;
    }
  EXPECT_EQ(checked, 4 * fabric.mesh.triangle.size());
}

TEST(Fabric, CellsHoldAboutTheWantedNumberOfPatches) {
  for (const double wanted : {3.0, 12.0, 48.0}) {
    FabricSpec spec = metric_spec();
    spec.patches_per_cell = wanted;
    const Fabric fabric = knit_fabric(make_swatch(0.06, 0.06, 3, 3), stockinette_pattern(), spec);
    std::set<uint32_t> used;
    for (const Patch& patch : fabric.patches) used.insert(patch.cell);
    const double mean = double(fabric.patches.size()) / double(used.size());
    EXPECT_GT(mean, wanted / 2) << wanted;
    EXPECT_LT(mean, wanted * 2) << wanted;
  }
}

TEST(Fabric, BothChartsOfAPillowOverlapAtTheBorder) {
  const Fabric fabric = knit_fabric(make_pillow(0.04, 0.03, 0.01, 16, 14), stockinette_pattern(), metric_spec());
  const double half = 0.5 * std::min(fabric.report.stitch_metres.x, fabric.report.stitch_metres.y);
  ASSERT_EQ(fabric.charts.size(), 2u);
  double beyond[2][4] = {};
  for (const PlyRun& run : fabric.runs) {
    const Chart& chart = fabric.charts[run.chart];
    for (uint32_t v = run.first_vertex; v < run.first_vertex + run.count * run.plies; ++v) {
      const dvec2 uv = uv_of(fabric, fabric.anchors[v]), lo = chart.uv_min - uv, hi = uv - chart.uv_max;
      double* b = beyond[run.chart];
      b[0] = std::max(b[0], lo.x), b[1] = std::max(b[1], lo.y), b[2] = std::max(b[2], hi.x),
      b[3] = std::max(b[3], hi.y);
    }
  }
  for (const auto& chart : beyond)
    for (const double b : chart) EXPECT_GT(b, 0.8 * half);
}

TEST(Fabric, TwoRunsAreIdentical) {
  const Fabric a = tube(), b = tube();
  ASSERT_EQ(a.anchors.size(), b.anchors.size());
  EXPECT_EQ(std::memcmp(a.anchors.data(), b.anchors.data(), a.anchors.size() * sizeof(Anchor)), 0);
  ASSERT_EQ(a.patches.size(), b.patches.size());
  EXPECT_EQ(std::memcmp(a.patches.data(), b.patches.data(), a.patches.size() * sizeof(Patch)), 0);
  EXPECT_EQ(a.cell_segments.item, b.cell_segments.item);
  EXPECT_EQ(a.cell_triangles.item, b.cell_triangles.item);
}

TEST(Fabric, ThreadsChangeNothing) {
  FabricSpec plain = metric_spec(), places = metric_spec(), hairy = metric_spec(), fibres = metric_spec();
  places.places = true;
  hairy.flyaways.hairs = hairy.flyaways.loops = 500;
  fibres.detail = Detail::fibres;
  fibres.fibres.fibres = 6;
  for (const FabricSpec& spec : {plain, places, hairy, fibres})
    for (const BaseMesh& mesh : {make_tube(0.01, 0.008, 48, 12), make_pillow(0.03, 0.02, 0.01, 8, 8)}) {
      const Fabric a = knit_fabric(mesh, stockinette_pattern(), spec, 1);
      const Fabric b = knit_fabric(mesh, stockinette_pattern(), spec, 5);
      ASSERT_GT(a.report.full_yarns, 5u) << "of several yarns";
      ASSERT_EQ(a.anchors.size(), b.anchors.size());
      EXPECT_EQ(std::memcmp(a.anchors.data(), b.anchors.data(), a.anchors.size() * sizeof(Anchor)), 0);
      ASSERT_EQ(a.place.size(), b.place.size());
      if (spec.places) EXPECT_EQ(std::memcmp(&a.place[0], &b.place[0], a.place.size() * sizeof(StrandPlace)), 0);
      ASSERT_EQ(a.runs.size(), b.runs.size());
      for (size_t r = 0; r < a.runs.size(); ++r) {
        const auto all = [](const PlyRun& run) {
          return std::tuple(run.first_vertex, run.count, run.plies, run.kind, run.radius, run.yarn, run.chart, run.ply,
                            run.first_place, run.one_place, run.ghost_ends);
        };
        ASSERT_EQ(all(a.runs[r]), all(b.runs[r])) << "run " << r;
      }
      ASSERT_EQ(a.patches.size(), b.patches.size());
      EXPECT_EQ(std::memcmp(a.patches.data(), b.patches.data(), a.patches.size() * sizeof(Patch)), 0);
      EXPECT_EQ(a.cell_segments.item, b.cell_segments.item);
      EXPECT_EQ(a.report.full_yarns, b.report.full_yarns);
      EXPECT_EQ(a.report.flyaways, b.report.flyaways);
      EXPECT_EQ(a.report.samples_outside, b.report.samples_outside);
      EXPECT_EQ(a.report.samples_extrapolated, b.report.samples_extrapolated);
      EXPECT_EQ(a.report.jumps_cut, b.report.jumps_cut);
    }
}

TEST(Fabric, ListsOfCellsAreMadeWhereTheyAreAskedFor) {
  FabricSpec spec = metric_spec();
  const Fabric with = tube(0.01);
  spec.cell_lists = false;
  const Fabric without = knit_fabric(make_tube(0.01, 0.01, 48, 12), stockinette_pattern(), spec);
  EXPECT_GT(with.cell_segments.item.size(), 0u);
  EXPECT_EQ(with.cell_segments.offset.size(), cell_count(with) + 1);
  EXPECT_TRUE(without.cell_segments.offset.empty() && without.cell_triangles.offset.empty());
  EXPECT_EQ(cell_count(without), cell_count(with));
  ASSERT_EQ(with.patches.size(), without.patches.size());
  EXPECT_EQ(std::memcmp(with.patches.data(), without.patches.data(), with.patches.size() * sizeof(Patch)), 0);
}

TEST(Fabric, RepeatsAndGaugeGiveTheSizesTheyName) {
  const BaseMesh mesh = make_swatch(0.04, 0.03, 4, 4);
  BaseMesh unit = mesh;  // UV in [0,1]
  for (auto& t : unit.uv)
    for (dvec2& uv : t) uv /= dvec2(0.04, 0.03);
  FabricSpec spec = metric_spec();
  spec.scale.kind = FabricScale::Kind::repeats;
  spec.scale.repeats = {20, 10};
  const Fabric repeated = knit_fabric(unit, stockinette_pattern(), spec);
  EXPECT_NEAR(repeated.report.tile_metres.x, 0.002, 1e-12);
  EXPECT_NEAR(repeated.report.tile_metres.y, 0.003, 1e-12);
  EXPECT_NEAR(repeated.uv_per_metre[0].x, 25, 1e-9);
  EXPECT_EQ(repeated.report.full_yarns, 12u);  // 10 courses and one tile of margin on each side

  spec.scale.kind = FabricScale::Kind::gauge;
  spec.scale.gauge = {400, 0};
  const Pattern pattern = stockinette_pattern();
  const Fabric gauged = knit_fabric(unit, pattern, spec);
  EXPECT_NEAR(gauged.report.stitch_metres.x, 0.0025, 1e-12);
  EXPECT_NEAR(gauged.report.stitch_metres.y / gauged.report.stitch_metres.x,
              pattern.period.y / pattern.stitches.y / (pattern.period.x / pattern.stitches.x), 1e-12);
  const double factor = 0.0025 / (pattern.period.x / pattern.stitches.x);
  EXPECT_NEAR(gauged.yarn_radius, pattern.yarn_radius * factor, 1e-12);
}

TEST(Fabric, ThicknessPlyRadiusAndOffset) {
  const BaseMesh mesh = make_swatch(0.02, 0.02, 2, 2);
  const Pattern pattern = stockinette_pattern();
  FabricSpec spec = metric_spec();
  const Fabric plain = knit_fabric(mesh, pattern, spec);
  spec.thickness = 0.5;
  spec.height_offset = 0.004;
  spec.ply_radius = 0.1 * plain.yarn_radius;
  const Fabric thin = knit_fabric(mesh, pattern, spec);
  EXPECT_NEAR(thin.yarn_radius, 0.5 * plain.yarn_radius, 1e-15);
  EXPECT_EQ(thin.ply_radius, spec.ply_radius);
  double lowest = 1;
  for (const Anchor& a : thin.anchors) lowest = std::min(lowest, double(a.height));
  EXPECT_GT(lowest, 0.001);
}

TEST(Fabric, MirroredUvMirrorsTheClothAndIsReported) {
  BaseMesh mesh = make_swatch(0.02, 0.02, 4, 4);
  const Fabric straight = knit_fabric(mesh, stockinette_pattern(), metric_spec());
  for (auto& t : mesh.uv)
    for (dvec2& uv : t) uv.x = 0.02 - uv.x;
  const Fabric mirrored = knit_fabric(mesh, stockinette_pattern(), metric_spec());
  EXPECT_FALSE(straight.report.mirrored);
  EXPECT_TRUE(mirrored.report.mirrored);
  ASSERT_EQ(straight.anchors.size(), mirrored.anchors.size());
  for (size_t v = 0; v < straight.anchors.size(); v += 11) {
    const dvec3 a = place(straight, straight.anchors[v]), b = place(mirrored, mirrored.anchors[v]);
    EXPECT_LT(glm::length(a - b * dvec3(-1, 1, 1)), 1e-8);
  }
}

TEST(Fabric, AYarnDoesNotCrossASlitInUv) {
  // A washer cut open and unrolled would join; here a bent strip whose two arms touch in UV but not in space.
  BaseMesh mesh = make_swatch(0.04, 0.04, 8, 8);
  for (dvec3& p : mesh.position)
    if (p.x > 1e-9) p.z += 0.05 * (p.y + 0.02) / 0.04;  // right half rises towards one end ...
  const size_t columns = 9;
  for (size_t j = 2; j <= 8; ++j) {  // ... and is cut from the left one along x = 0, but for the first row
    const uint32_t old = static_cast<uint32_t>(j * columns + 4), copy = static_cast<uint32_t>(mesh.position.size());
    mesh.position.push_back(mesh.position[old] + dvec3(0, 0, 0.05 * (mesh.position[old].y + 0.02) / 0.04));
    for (size_t t = 0; t < mesh.triangle.size(); ++t)
      if (mesh.uv[t][0].x + mesh.uv[t][1].x + mesh.uv[t][2].x > 0.06)
        for (uint32_t& v : mesh.triangle[t])
          if (v == old) v = copy;
  }
  compute_normals(mesh);
  ASSERT_EQ(find_charts(mesh).size(), 1u);
  const Fabric fabric = knit_fabric(mesh, stockinette_pattern(), metric_spec());
  expect_sound(fabric);
  EXPECT_GT(fabric.report.jumps_cut, 0u);
  double longest = 0;
  for (const uint32_t id : all_segments(fabric))
    longest = std::max(longest, glm::length(place(fabric, fabric.anchors[id + 1]) - place(fabric, fabric.anchors[id])));
  EXPECT_LT(longest, 0.003);  // the slit gapes by up to 50 mm
}

TEST(Fabric, TileLargerThanTheClothIsRefused) {
  EXPECT_NE(message([] {
              knit_fabric(make_swatch(0.001, 0.02, 2, 2), stockinette_pattern(), metric_spec());
            }).find("larger than the cloth"),
            std::string::npos);
}

TEST(Fabric, ValuesOutOfRangeAreRefusedWithTheValidOnes) {
  const auto refused = [](const std::function<void(FabricSpec&)>& change, const std::string& part) {
    FabricSpec spec = metric_spec();
    change(spec);
    const std::string text = message([&] { knit_fabric(make_swatch(0.02, 0.02, 2, 2), stockinette_pattern(), spec); });
    EXPECT_NE(text.find(part), std::string::npos) << text;
    EXPECT_EQ(text.find('\n'), std::string::npos);
  };
  refused([](FabricSpec& s) { s.plies = 9; }, "1 to 8");
  refused([](FabricSpec& s) { s.plies = 0; }, "1 to 8");
  refused([](FabricSpec& s) { s.twist_pitch = 1; }, "at least 2");
  refused([](FabricSpec& s) { s.twist_pitch = NAN; }, "at least 2");
  refused([](FabricSpec& s) { s.thickness = 0; }, "thickness");
  refused([](FabricSpec& s) { s.tolerance = -1; }, "tolerance");
  refused([](FabricSpec& s) { s.ply_radius = 1; }, "does not fit");
  refused([](FabricSpec& s) { s.patches_per_cell = 0; }, "patches per cell");
  refused([](FabricSpec& s) { s.scale = {FabricScale::Kind::repeats, {0, 1}, {0, 0}}; }, "repeats along u");
  refused([](FabricSpec& s) { s.scale = {FabricScale::Kind::gauge, {1, 1}, {0, 0}}; }, "gauge");
  refused([](FabricSpec& s) { s.scale = {FabricScale::Kind::gauge, {1, 1}, {1e12, 0}}; }, "tiles across");
  refused([](FabricSpec& s) { s.scale = {FabricScale::Kind::gauge, {1, 1}, {1e7, 0}}; }, "coarser scale");
}

TEST(Fabric, MeshWithoutUvIsRefused) {
  BaseMesh mesh = make_swatch(0.02, 0.02, 2, 2);
  mesh.uv.clear();
  EXPECT_NE(message([&] { knit_fabric(mesh, stockinette_pattern(), metric_spec()); }).find("no UV"), std::string::npos);
}

}  // namespace
}  // namespace wale
