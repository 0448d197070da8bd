// Every sample of a knit knows its stitch and its place along the strand.
#include "geom/stitch_places.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "geom/base_mesh_generators.h"
#include "geom/fabric.h"

namespace wale {
namespace {

Fabric knit(BaseMesh mesh, const Pattern& pattern, FabricScale scale = {FabricScale::Kind::uv_metres, {1, 1}, {0, 0}}) {
  FabricSpec spec;
  spec.name = "cloth";
  spec.scale = scale;
  spec.plies = 2;
  spec.places = true;
  return knit_fabric(std::move(mesh), pattern, spec);
}

/// Two courses of three stitches each in one tile, the second shifted by half a stitch, each cut into two curves.
Pattern three_by_two() {
  const Pattern one = stockinette_pattern();
  Pattern p;
  p.name = "three by two";
  p.period = {3 * one.period.x, 2 * one.period.y};
  p.yarn_radius = one.yarn_radius;
  p.stitches = {3, 2};
  for (int row = 0; row < 2; ++row) {
    std::vector<dvec3> points;
    const auto& loop = one.curves[0].points;
    for (int stitch = 0; stitch < 3; ++stitch)
      for (size_t i = 0; i + 1 < loop.size(); ++i)
        points.push_back(loop[i] + dvec3((stitch + 0.25 * row) * one.period.x, row * one.period.y, 0));
    points.push_back(points.front() + dvec3(p.period.x, 0, 0));
    const size_t cut = points.size() / 2 + 5;
    p.curves.push_back({{points.begin(), points.begin() + long(cut) + 1}, false});
    p.curves.push_back({{points.begin() + long(cut), points.end()}, false});
  }
  return p;
}

/// Samples of every stitch: its loop must be in one piece, of one yarn, and as long as all others.
void expect_loops(const Fabric& fabric, const Pattern& pattern, size_t least) {
  std::map<std::pair<int, int>, std::set<uint32_t>> yarns;
  std::map<std::pair<int, int>, double> length;
  std::set<uint32_t> ends;
  for (const PlyRun& run : fabric.runs)
    for (uint32_t k = 0; k + 1 < run.count; ++k) {
      const StrandPlace &a = fabric.place[run.first_vertex / 2 + k], &b = fabric.place[run.first_vertex / 2 + k + 1];
      const std::pair stitch(a.stitch.x, a.stitch.y);
      yarns[stitch].insert(run.yarn);
      length[stitch] += std::abs(b.along - a.along);
      EXPECT_LE(std::abs(b.stitch.x - a.stitch.x), 1);
      EXPECT_EQ(a.stitch.y, b.stitch.y);
    }
  double longest = 0;
  for (const auto& [stitch, l] : length) longest = std::max(longest, l);
  size_t whole = 0;
  for (const auto& [stitch, l] : length) {
    EXPECT_EQ(yarns[stitch].size(), 1u) << stitch.first << ", " << stitch.second;
    whole += l > 0.9 * longest;
  }
  EXPECT_GE(whole, least);
  const double stitch_length = longest;
  EXPECT_GT(stitch_length, 2.5 * pattern.period.x / pattern.stitches.x);
  EXPECT_LT(stitch_length, 5 * pattern.period.x / pattern.stitches.x);
}

TEST(StitchPlaces, ALoopWithItsHeadIsOneStitch) {
  const Pattern tile = stockinette_pattern();
  const Fabric fabric = knit(make_swatch(0.024, 0.02, 4, 4), tile);
  ASSERT_EQ(fabric.place.size() * 2, fabric.anchors.size());
  expect_loops(fabric, tile, 100);
  // The middle in UV is where the numbers say, and inside the course that the loop's mean height lies in.
  for (const StrandPlace& p : fabric.place) {
    EXPECT_NEAR(p.u / tile.period.x - p.stitch.x, 0.0, 0.51);
    const StrandPlace& q = fabric.place[0];
    EXPECT_NEAR(p.u - q.u, (p.stitch.x - q.stitch.x) * tile.period.x, 1e-8);
    EXPECT_NEAR(p.v - q.v, (p.stitch.y - q.stitch.y) * tile.period.y, 1e-8);
  }
}

TEST(StitchPlaces, TilesOfManyStitches) {
  const Pattern tile = three_by_two();
  const Fabric fabric = knit(make_swatch(0.024, 0.02, 4, 4), tile);
  expect_loops(fabric, tile, 100);
  std::set<int> columns, rows;
  for (const StrandPlace& p : fabric.place) columns.insert(p.stitch.x), rows.insert(p.stitch.y);
  EXPECT_NEAR(double(columns.size()), 0.024 / (tile.period.x / 3), 3);
  EXPECT_NEAR(double(rows.size()), 0.02 / (tile.period.y / 2), 4);
}

// On a tube the numbers go round once and the strand goes on from round to round.
TEST(StitchPlaces, RoundsOfATube) {
  const Pattern tile = stockinette_pattern();
  const Fabric fabric = knit(make_tube(0.01, 0.02, 32, 8), tile);
  ASSERT_FALSE(fabric.report.snapped_repeats.empty());
  const int around = fabric.report.snapped_repeats[0].x;
  std::map<int, std::set<int>> columns;
  double longest = 0;
  std::vector<std::pair<double, int>> starts;
  for (const PlyRun& run : fabric.runs) {
    for (uint32_t k = 0; k < run.count; ++k) {
      const StrandPlace& p = fabric.place[run.first_vertex / 2 + k];
      columns[p.stitch.y].insert(p.stitch.x);
      longest = std::max<double>(longest, p.along);
    }
    if (!run.ghost_ends) continue;
    EXPECT_EQ(fabric.place[run.first_vertex / 2].stitch, fabric.place[run.first_vertex / 2 + run.count - 3].stitch);
    starts.emplace_back(fabric.place[run.first_vertex / 2 + 1].along, fabric.place[run.first_vertex / 2 + 1].stitch.y);
  }
  size_t whole = 0;
  for (const auto& [row, c] : columns) {
    EXPECT_LE(int(c.size()), around);
    whole += int(c.size()) == around;
  }
  EXPECT_GE(whole, 8u);
  ASSERT_GE(starts.size(), 8u);
  for (size_t i = 1; i < starts.size(); ++i) {
    EXPECT_GT(starts[i].first, starts[i - 1].first) << "round after round";
    EXPECT_EQ(starts[i].second, starts[i - 1].second + 1);
  }
  EXPECT_GT(longest, starts.back().first);
}

TEST(StitchPlaces, NothingIsKeptWhereNothingAsks) {
  FabricSpec spec;
  spec.scale.kind = FabricScale::Kind::uv_metres;
  EXPECT_TRUE(knit_fabric(make_swatch(0.02, 0.02, 4, 4), stockinette_pattern(), spec).place.empty());
}

}  // namespace
}  // namespace wale
