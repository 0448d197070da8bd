// A cloth that is knitted anew on other triangles and in another shape is the same cloth: the scale is that of its
// rest.
#include <gtest/gtest.h>

#include <cmath>

#include "geom/base_mesh_generators.h"
#include "geom/fabric.h"
#include "geom/stored_length.h"
#include "tests/geom/remeshed.h"
#include "tests/temporary_folder.h"
#include "tests/tolerances.h"

namespace wale {
namespace {

using test::remeshed_cloth;

FabricSpec gauge() {
  FabricSpec spec;
  spec.name = "cloth";
  spec.scale.kind = FabricScale::Kind::gauge;
  spec.scale.gauge = {250, 0};
  return spec;
}

dvec3 flat(dvec2 uv) { return {uv.x, uv.y, 0}; }
// Stretched by up to a third along x, squeezed along y, and thrown into folds.
dvec3 at_time(dvec2 uv, double t) {
  return {uv.x * (1 + 0.33 * t), uv.y * (1 - 0.2 * t), 0.01 * t * std::sin(60 * uv.x + 9 * t)};
}

dvec2 uv_of(const Fabric& fabric, const Anchor& a) {
  const auto& uv = fabric.mesh.uv[a.triangle];
  return uv[0] + double(a.b1) * (uv[1] - uv[0]) + double(a.b2) * (uv[2] - uv[0]);
}

// Of every point of the yarns: where it lies in UV, its length along the yarn, its height and the azimuth of its frame.
TEST(RestScale, APointKeepsItsLengthAndAzimuthUnderItsUv) {
  const dvec2 size(0.12, 0.1);
  const Pattern pattern = stockinette_pattern(0.004);
  const auto rest = std::make_shared<BaseMesh>(remeshed_cloth(size, 1, flat));
  const Fabric still = knit_fabric(*rest, pattern, gauge());
  ASSERT_GT(still.anchors.size(), 10000u);
  for (uint32_t frame = 1; frame <= 6; ++frame) {
    BaseMesh mesh = remeshed_cloth(size, 100 + frame, [&](dvec2 uv) { return at_time(uv, frame / 6.0); });
    ASSERT_NE(mesh.triangle, rest->triangle);
    mesh.rest = rest;
    const Fabric moved = knit_fabric(mesh, pattern, gauge());
    ASSERT_EQ(moved.anchors.size(), still.anchors.size()) << frame;
    ASSERT_EQ(moved.runs.size(), still.runs.size());
    EXPECT_NEAR(moved.ply_radius, still.ply_radius, 1e-12);
    double worst_uv = 0, worst_length = 0, worst_turn = 0, worst_height = 0;
    for (size_t i = 0; i < still.anchors.size(); ++i) {
      const Anchor &a = still.anchors[i], &b = moved.anchors[i];
      worst_uv = std::max(worst_uv, glm::length(uv_of(moved, b) - uv_of(still, a)));
      worst_length = std::max(worst_length, std::abs(double(a.length) - double(b.length)));
      worst_height = std::max(worst_height, std::abs(double(a.height) - double(b.height)));
      worst_turn = std::max(worst_turn, glm::length(dvec3(a.nx, a.ny, a.nz) - dvec3(b.nx, b.ny, b.nz)));
    }
    EXPECT_LT(worst_uv, tolerance::kSameLength) << frame;
    EXPECT_LT(worst_length, tolerance::kSameLength) << frame;
    EXPECT_LT(worst_height, tolerance::kSameLength) << frame;
    EXPECT_LT(worst_turn, tolerance::kSameDirection) << frame;
  }
}

// Without a rest the stretched cloth is knitted to its gauge: it has more stitches, and its detail would swim.
TEST(RestScale, IsWhatMakesThemTheSame) {
  const Pattern pattern = stockinette_pattern(0.004);
  const Fabric still = knit_fabric(remeshed_cloth({0.12, 0.1}, 1, flat), pattern, gauge());
  const Fabric moved =
      knit_fabric(remeshed_cloth({0.12, 0.1}, 2, [](dvec2 uv) { return at_time(uv, 1); }), pattern, gauge());
  EXPECT_NE(moved.anchors.size(), still.anchors.size());
}

TEST(RestScale, ChartsOfAnotherClothAreRefused) {
  BaseMesh mesh = remeshed_cloth({0.12, 0.1}, 2, flat);
  mesh.name = "c_07.obj";
  mesh.rest = std::make_shared<BaseMesh>(remeshed_cloth({0.5, 0.5}, 1, flat));
  EXPECT_EQ(user_message([&] { knit_fabric(mesh, stockinette_pattern(0.004), gauge()); }),
            "c_07.obj: its chart of UV (0, 0) to (0.12, 0.1) is not in the rest frame; UV must be those of the same "
            "cloth in every frame");
}

}  // namespace
}  // namespace wale
