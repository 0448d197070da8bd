// A tube and a pillow, knitted so tight that no ray passes: no hole, slit or frayed edge along a seam or a border.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/image/cloth_holes.h"
#include "tests/image/picture.h"

namespace wale::test {
namespace {

// Stockinette of yarns thick enough to fill its own openings, of plies that let nothing through.
Scene cloth(const std::string& generator, double thickness) {
  Scene scene = empty_scene(0.01, 8);
  MaterialSpec material;
  material.name = "yarn";
  material.ply = true;
  material.yarn.optical_radius = 100;
  scene.materials.push_back(material);
  FabricScene fabric;
  fabric.spec.name = generator;
  fabric.spec.scale.kind = FabricScale::Kind::uv_metres;
  fabric.spec.plies = 3;
  fabric.spec.thickness = thickness;
  fabric.mesh.generator = generator;
  fabric.mesh.radius = 0.008;
  fabric.mesh.height = generator == "tube" ? 0.024 : 0.02;
  fabric.mesh.width = 0.024;
  fabric.mesh.thickness = 0.008;
  fabric.mesh.nu = 24;
  fabric.mesh.nv = 12;
  fabric.pattern.builtin = "stockinette";
  scene.fabrics.push_back(fabric);
  return scene;
}

constexpr double kClosed = 2.2;  // thickness: the pillow's cloth is stretched by its filling

struct View {
  dvec3 target, direction;
};

// Towards the seam at angle 0, beside it, and towards the back; level, from above and from below.
std::vector<View> tube_views() {
  std::vector<View> views;
  for (const double azimuth : {0.0, 0.4, -0.4, 2.4})
    for (const double elevation : {0.0, 0.5, -0.5}) {
      const dvec3 out(std::cos(azimuth) * std::cos(elevation), std::sin(azimuth) * std::cos(elevation),
                      std::sin(elevation));
      views.push_back({dvec3(0, 0, 0.012), -out});
    }
  return views;
}

// From above and below, and on to all four seams and a corner from level to 60 degrees.
std::vector<View> pillow_views() {
  std::vector<View> views = {{dvec3(0), dvec3(0, 0, -1)}, {dvec3(0), dvec3(0, 0, 1)}};
  for (const double azimuth : {0.0, 0.5, 1.0, 1.5})
    for (const double elevation : {0.0, 0.5, -1.0}) {
      const double a = azimuth * 3.14159265, c = std::cos(elevation);
      views.push_back({dvec3(0), -dvec3(c * std::cos(a), c * std::sin(a), std::sin(elevation))});
    }
  views.push_back({dvec3(0), dvec3(-1, -1, -0.3)});
  return views;
}

HoleCount count(const World& world, const Scene& scene, const std::vector<View>& views) {
  const BaseMesh mesh = load_mesh(scene.fabrics[0].mesh, Loaders{});
  HoleCount holes;
  for (const View& view : views) count_holes(world, mesh, view.target, view.direction, 0.034, 150, holes);
  return holes;
}

class ClosedFabric : public testing::TestWithParam<const char*> {
 protected:
  std::vector<View> views() const { return std::string(GetParam()) == "tube" ? tube_views() : pillow_views(); }
};

TEST_P(ClosedFabric, NoHoleSlitOrFrayedEdgeAtSeamsAndBorders) {
  const Scene scene = cloth(GetParam(), kClosed);
  const HoleCount holes = count(build_world(scene, Loaders{}), scene, views());
  fmt::print("{}: {} of {} rays pass in the middle, {} of {} at seams and borders, {} stray hits\n", GetParam(),
             holes.passed[0], holes.rays[0], holes.passed[1], holes.rays[1], holes.stray);
  ASSERT_GT(holes.rays[0], 20000u);
  ASSERT_GT(holes.rays[1], 10000u);
  EXPECT_EQ(holes.passed[0], 0u) << "the cloth is not closed: this test would not see a slit";
  EXPECT_EQ(holes.passed[1], 0u);
  EXPECT_EQ(holes.stray, 0u);
}

// The counter counts: thin yarns leave openings everywhere, and a cloth without its outermost yarn gapes at its
// borders.
TEST_P(ClosedFabric, OpeningsAndAMissingBorderAreCounted) {
  const std::vector<View> all = views(), some(all.begin(), all.begin() + 4);
  const Scene thin = cloth(GetParam(), 0.8);
  EXPECT_GT(count(build_world(thin, Loaders{}), thin, some).rate(0), 0.05);

  const Scene closed = cloth(GetParam(), kClosed);
  World world = build_world(closed, Loaders{});
  Fabric& fabric = world.fabrics[0];
  std::erase_if(fabric.patches, [&](const Patch& patch) {
    const PlyRun& run = fabric.runs[patch.run];
    const Anchor& a = fabric.anchors[run.first_vertex + patch.first];
    const auto& uv = fabric.mesh.uv[a.triangle];
    const dvec2 at = uv[0] + double(a.b1) * (uv[1] - uv[0]) + double(a.b2) * (uv[2] - uv[0]);
    const Chart& chart = fabric.charts[run.chart];
    const dvec2 inside = glm::min(at - chart.uv_min, chart.uv_max - at) / fabric.report.stitch_metres;
    return std::min(inside.x, inside.y) < 0.25;
  });
  const HoleCount holes = count(world, closed, some);
  EXPECT_GT(holes.rate(1), 0.01);
  EXPECT_EQ(holes.passed[0], 0u);
}

INSTANTIATE_TEST_SUITE_P(All, ClosedFabric, testing::Values("tube", "pillow"),
                         [](const auto& test) { return std::string(test.param); });

}  // namespace
}  // namespace wale::test
