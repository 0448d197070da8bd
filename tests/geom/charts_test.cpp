// Charts, joins and the locator.
#include "geom/charts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "geom/base_mesh_generators.h"
#include "geom/mesh_edges.h"

namespace wale {
namespace {

dvec2 uv_at(const BaseMesh& mesh, const ChartPoint& at) {
  const auto& t = mesh.uv[at.triangle];
  return (1 - at.b1 - at.b2) * t[0] + at.b1 * t[1] + at.b2 * t[2];
}

TEST(Charts, SwatchIsOneOpenChart) {
  const auto charts = find_charts(make_swatch(0.2, 0.1, 5, 4));
  ASSERT_EQ(charts.size(), 1u);
  EXPECT_TRUE(charts[0].joins.empty());
  EXPECT_FALSE(charts[0].mirrored);
  EXPECT_NEAR(charts[0].metres_per_uv.x, 1, 1e-12);
  EXPECT_NEAR(charts[0].metres_per_uv.y, 1, 1e-12);
}

TEST(Charts, TubeJoinsOnceAlongU) {
  const auto charts = find_charts(make_tube(0.05, 0.2, 24, 10));
  ASSERT_EQ(charts.size(), 1u);
  ASSERT_EQ(charts[0].joins.size(), 1u);
  EXPECT_NEAR(charts[0].joins[0].x, 2 * std::numbers::pi * 0.05, 1e-12);
  EXPECT_EQ(charts[0].joins[0].y, 0);
}

TEST(Charts, BeanieHasAJoinedWallAndAnOpenCrown) {
  const auto charts = find_charts(make_beanie(0.09, 0.2, 48, 40));
  ASSERT_EQ(charts.size(), 2u);
  EXPECT_EQ(charts[0].joins.size(), 1u);
  EXPECT_TRUE(charts[1].joins.empty());
  EXPECT_FALSE(charts[0].mirrored || charts[1].mirrored);
}

TEST(Charts, MirroredUvIsSeen) {
  BaseMesh mesh = make_swatch(0.2, 0.1, 3, 3);
  for (auto& t : mesh.uv)
    for (dvec2& uv : t) uv.x = -uv.x;
  EXPECT_TRUE(find_charts(mesh)[0].mirrored);
  EXPECT_EQ(validate(mesh).flipped_uv, 0u);
}

// Every bucket would list every one of them: the lists must stay in proportion to the mesh.
TEST(Charts, ThousandsOfTrianglesInOnePlaceAreLocatedAsTheFirst) {
  BaseMesh mesh;
  mesh.position = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  for (int i = 0; i < 20000; ++i) {
    mesh.triangle.push_back({0, 1, 2});
    mesh.uv.push_back({dvec2(0, 0), dvec2(1, 0), dvec2(0, 1)});
  }
  compute_normals(mesh);
  Chart chart;
  for (uint32_t t = 0; t < mesh.triangle.size(); ++t) chart.triangles.push_back(t);
  chart.uv_max = {1, 1};
  const ChartLocator locator(mesh, chart);
  for (int i = 0; i < 100; ++i) {
    ChartPoint point;
    ASSERT_TRUE(locator.locate({0.004 * i, 0.3}, 0.1, {1, 1}, point));
    EXPECT_EQ(point.triangle, 0u);
    ASSERT_TRUE(locator.locate({0.004 * i, -0.05}, 0.1, {1, 1}, point));
    EXPECT_EQ(point.triangle, 0u);
  }
}

TEST(Charts, AMoebiusSeamIsNotAJoin) {
  // Last column meets the first one turned over: the translation differs at the two ends of every seam edge.
  BaseMesh mesh = make_tube(0.05, 0.02, 24, 1);
  for (auto& t : mesh.triangle)
    for (size_t c = 0; c < 3; ++c) {
      const size_t index = static_cast<size_t>(&t - mesh.triangle.data());
      if (mesh.uv[index][c].x > 0.313) t[c] = mesh.uv[index][c].y > 0 ? 0 : 24;
    }
  const auto charts = find_charts(mesh);
  ASSERT_EQ(charts.size(), 1u);
  EXPECT_TRUE(charts[0].joins.empty());
}

TEST(Charts, ATransposedTubeJoinsAlongV) {
  BaseMesh mesh = make_tube(0.05, 0.2, 24, 10);
  for (auto& t : mesh.uv)
    for (dvec2& uv : t) uv = {-uv.y, uv.x};
  const auto charts = find_charts(mesh);
  ASSERT_EQ(charts[0].joins.size(), 1u);
  EXPECT_EQ(charts[0].joins[0].x, 0);
  EXPECT_NEAR(charts[0].joins[0].y, 2 * std::numbers::pi * 0.05, 1e-12);
}

TEST(Locator, EveryPointInsideIsFoundAndMapsBackToItself) {
  const BaseMesh mesh = make_swatch(0.2, 0.1, 13, 7);
  const auto charts = find_charts(mesh);
  const ChartLocator locator(mesh, charts[0]);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> u(0, 0.2), v(0, 0.1);
  for (int i = 0; i < 20000; ++i) {
    const dvec2 uv(u(random), v(random));
    ChartPoint at;
    ASSERT_TRUE(locator.locate(uv, 0, {1, 1}, at));
    EXPECT_EQ(at.outside, 0);
    EXPECT_LT(glm::length(uv_at(mesh, at) - uv), 1e-15);
    EXPECT_GE(std::min({at.b1, at.b2, 1 - at.b1 - at.b2}), -1e-12);
  }
}

TEST(Locator, PointsOnEdgesAndVerticesGoToTheLowestTriangle) {
  // Powers of two, so that midpoints lie on their edges to the last bit.
  const BaseMesh mesh = make_swatch(1, 1, 8, 8);
  const auto charts = find_charts(mesh);
  const ChartLocator locator(mesh, charts[0]);
  std::vector<std::vector<uint32_t>> around(mesh.position.size());
  for (uint32_t t = 0; t < mesh.triangle.size(); ++t)
    for (const uint32_t v : mesh.triangle[t]) around[v].push_back(t);
  for (uint32_t t = 0; t < mesh.triangle.size(); ++t)
    for (size_t c = 0; c < 3; ++c) {
      const uint32_t a = mesh.triangle[t][c], b = mesh.triangle[t][(c + 1) % 3];
      ChartPoint at;
      ASSERT_TRUE(locator.locate(mesh.uv[t][c], 0, {1, 1}, at));
      EXPECT_EQ(at.triangle, around[a].front());
      uint32_t lowest = 0xffffffffu;
      for (const uint32_t i : around[a])
        if (std::find(around[b].begin(), around[b].end(), i) != around[b].end()) lowest = std::min(lowest, i);
      ASSERT_TRUE(locator.locate(0.5 * (mesh.uv[t][c] + mesh.uv[t][(c + 1) % 3]), 0, {1, 1}, at));
      EXPECT_EQ(at.triangle, lowest);
    }
}

TEST(Locator, NoPointFallsBetweenTriangles) {
  // Points as near to shared edges as rounding allows, on edges of any slope.
  BaseMesh mesh = make_swatch(1, 1, 6, 6);
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> shift(-0.04, 0.04), along(0, 1);
  std::vector<dvec2> moved(mesh.position.size());
  for (dvec2& d : moved) d = {shift(random), shift(random)};
  for (size_t t = 0; t < mesh.triangle.size(); ++t)
    for (size_t c = 0; c < 3; ++c) mesh.uv[t][c] += moved[mesh.triangle[t][c]];
  const auto charts = find_charts(mesh);
  ASSERT_EQ(charts.size(), 1u);
  const ChartLocator locator(mesh, charts[0]);
  for_each_edge(sorted_sides(mesh), [&](std::span<const TriangleSide> edge) {
    if (edge.size() != 2) return;
    const auto uv = side_uv(mesh, edge[0]);
    for (int i = 0; i < 200; ++i) {
      ChartPoint at;
      ASSERT_TRUE(locator.locate(glm::mix(uv[0], uv[1], along(random)), 0, {1, 1}, at));
      EXPECT_EQ(at.outside, 0);
      EXPECT_TRUE(at.triangle == edge[0].triangle || at.triangle == edge[1].triangle);
    }
  });
}

TEST(Locator, ReachIsMeasuredInTheMetric) {
  const BaseMesh mesh = make_swatch(1, 1, 4, 4);
  const auto charts = find_charts(mesh);
  const ChartLocator locator(mesh, charts[0]);
  ChartPoint at;
  EXPECT_FALSE(locator.locate({-0.01, 0.3}, 0.009, {1, 1}, at));
  ASSERT_TRUE(locator.locate({-0.01, 0.3}, 0.011, {1, 1}, at));
  EXPECT_NEAR(at.outside, 0.01, 1e-12);
  EXPECT_LT(glm::length(uv_at(mesh, at) - dvec2(-0.01, 0.3)), 1e-14);
  EXPECT_TRUE(locator.locate({-0.01, 0.3}, 0.009, {0.5, 1}, at));
  EXPECT_FALSE(locator.locate({0.3, 1.01}, 0.009, {0.5, 1}, at));
  EXPECT_FALSE(locator.locate({NAN, 0.3}, 0.1, {1, 1}, at));
}

TEST(Locator, WrapsAcrossAJoinByWholePeriods) {
  const BaseMesh mesh = make_tube(0.05, 0.2, 24, 10);
  const auto charts = find_charts(mesh);
  const ChartLocator locator(mesh, charts[0]);
  const double period = charts[0].joins[0].x;
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> u(0.001, period - 0.001), v(0, 0.2);
  for (int i = 0; i < 2000; ++i) {
    const dvec2 uv(u(random), v(random));
    ChartPoint at, moved;
    ASSERT_TRUE(locator.locate(uv, 0, {1, 1}, at));
    for (const double turns : {-2.0, -1.0, 1.0, 5.0}) {
      ASSERT_TRUE(locator.locate(uv + dvec2(turns * period, 0), 0, {1, 1}, moved));
      EXPECT_NEAR(glm::length(uv_at(mesh, moved) - uv), 0, 1e-13);
    }
  }
}

TEST(Locator, SkipsTrianglesWithoutUvAreaAndPrefersTheLowestOfOverlaps) {
  BaseMesh mesh = make_swatch(1, 1, 2, 2);
  const size_t count = mesh.triangle.size();
  for (size_t t = 0; t < count; ++t) {  // a second layer with the same UV and vertices
    mesh.triangle.push_back(mesh.triangle[t]);
    mesh.uv.push_back(mesh.uv[t]);
  }
  mesh.uv[0] = {dvec2(0.4, 0.1), dvec2(0.4, 0.1), dvec2(0.4, 0.1)};
  std::vector<Chart> charts(1);
  for (uint32_t t = 0; t < mesh.triangle.size(); ++t) charts[0].triangles.push_back(t);
  charts[0].uv_max = {1, 1};
  const ChartLocator locator(mesh, charts[0]);
  ChartPoint at;
  ASSERT_TRUE(locator.locate({0.4, 0.1}, 0, {1, 1}, at));
  EXPECT_EQ(at.triangle, count);  // the copy of triangle 0
  ASSERT_TRUE(locator.locate({0.1, 0.4}, 0, {1, 1}, at));
  EXPECT_EQ(at.triangle, 1u);
  EXPECT_NEAR(validate(mesh).overlap, 0.875, 0.01);
}

}  // namespace
}  // namespace wale
