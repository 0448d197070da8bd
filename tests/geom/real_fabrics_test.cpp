// Real meshes and real tiles knitted together: hard UVs must give finite anchors and no thread across the room.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "geom/fabric.h"
#include "geom/stored_length.h"
#include "geom/warp.h"

namespace wale {
namespace {

class RealFabrics : public testing::Test {
 protected:
  void SetUp() override {
    const char* folder = std::getenv("WALE_REAL_DATA");
    if (!folder) GTEST_SKIP() << "real data not present";
    data_ = folder;
    spec_.name = "real";
  }

  Fabric knit(const char* mesh, const char* tile) {
    return knit_fabric(read_mesh(data_ / "meshes" / mesh), read_pattern(data_ / "yarn-patterns/madypg" / tile), spec_);
  }

  std::filesystem::path data_;
  FabricSpec spec_;
};

dvec3 place(const Fabric& fabric, const Anchor& a) {
  return warp_point(fabric.mesh, {a.triangle, a.b1, a.b2, 0}, a.height);
}

/// Length of every traced segment on the mesh over its rest length, sorted.
std::vector<double> stretches(const Fabric& fabric) {
  std::vector<double> result;
  for (const PlyRun& run : fabric.runs)
    for (uint32_t p = 0; p < uint32_t(fabric.plies); ++p)
      for (uint32_t k = 0; k + 1 < run.count; ++k) {
        const Anchor* a = fabric.anchors.data() + run.first_vertex + p * run.count + k;
        result.push_back(glm::length(place(fabric, a[1]) - place(fabric, a[0])) /
                         length_between(a[0].length, a[1].length, fabric.ply_radius));
      }
  std::sort(result.begin(), result.end());
  return result;
}

TEST_F(RealFabrics, SockInStockinette) {
  spec_.scale.kind = FabricScale::Kind::gauge;
  spec_.scale.gauge = {150, 0};
  const Fabric fabric = knit("madypg/sock_cloth.obj", "stockinette.pyp");
  const auto stretch = stretches(fabric);
  EXPECT_NEAR(stretch[stretch.size() / 2], 1, 0.1);
  EXPECT_LT(stretch[stretch.size() * 9999 / 10000], 2);  // the mesh itself reaches 1.89
  EXPECT_LT(stretch.back(), 12);
  EXPECT_GT(fabric.report.segments, 500000u);
  EXPECT_LT(fabric.report.jumps_cut, 20u);
}

TEST_F(RealFabrics, SpotWithThirteenUnevenCharts) {
  spec_.scale.repeats = {60, 60};
  const Fabric fabric = knit("spot/spot_triangulated.obj", "stocktiny.pyp");
  const auto stretch = stretches(fabric);
  ASSERT_TRUE(std::isfinite(stretch.back()));
  EXPECT_LT(stretch[stretch.size() * 999 / 1000], 8);
}

TEST_F(RealFabrics, TeapotWithOverlappingUv) {
  spec_.scale.repeats = {60, 60};
  const Fabric fabric = knit("materialx/mtlx_teapot.obj", "stocktiny.pyp");
  const auto stretch = stretches(fabric);
  ASSERT_TRUE(std::isfinite(stretch.back()));
  EXPECT_LT(stretch[stretch.size() * 999 / 1000], 12);
}

TEST_F(RealFabrics, SphereClosesItsYarns) {
  spec_.scale.repeats = {40, 20};
  const Fabric fabric = knit("materialx/mtlx_sphere.obj", "stocktiny.pyp");
  const auto closed =
      std::count_if(fabric.runs.begin(), fabric.runs.end(), [](const PlyRun& r) { return r.ghost_ends; });
  EXPECT_GE(closed, 18);
}

TEST_F(RealFabrics, RibAndWovenTilesOnTheCube) {
  for (const char* tile : {"cartridge_belt_rib.pyp", "basket.pyp", "slip_stitch_honeycomb.pyp"}) {
    if (!std::filesystem::exists(data_ / "yarn-patterns/madypg" / tile)) continue;
    spec_.scale.repeats = {6, 6};
    const Fabric fabric = knit("materialx/mtlx_cube.obj", tile);
    EXPECT_EQ(fabric.charts.size(), 6u);
    const auto stretch = stretches(fabric);
    // Eight vertices share their normals between faces, so heights lean by up to 55 degrees.
    EXPECT_LT(stretch.back(), 1.6);
    EXPECT_GT(stretch.front(), 0.3);
  }
}

}  // namespace
}  // namespace wale
