// Loops under strain at the borders of what a table says: beyond its strains, other scales, no table.
#include "tests/geom/strained_fixtures.h"

namespace wale {
namespace {

using namespace test;

constexpr double kReach = 0.0004;  // metres per unit of strain

Fabric knit(const BaseMesh& mesh) {
  return knit_fabric(mesh, straining_tile(kReach), strained_spec(LoopStrain::relaxed, 1), 1);
}

TEST(Strain, BeyondTheTableItsBorderIsTakenAndCounted) {
  const BaseMesh far = moved(make_swatch(0.02, 0.012, 6, 4), [](dvec3 p) { return dvec3(1.9 * p.x, p.y, p.z); });
  const Fabric beyond = knit(far);
  EXPECT_GT(beyond.report.strain.samples, 0u);
  EXPECT_EQ(beyond.report.strain.clamped, beyond.report.strain.samples);
  EXPECT_NEAR(beyond.report.strain.most.x, 0.9, 1e-6);
  const BaseMesh border = moved(make_swatch(0.02, 0.012, 6, 4), [](dvec3 p) { return dvec3(1.5 * p.x, p.y, p.z); });
  const Fabric at_border = knit(border);
  EXPECT_EQ(at_border.report.strain.clamped, 0u);
  expect_same_bits(beyond, at_border);
}

// The yarn's own scale is the one through the cloth: a tile drawn out by the gauge is strained, one made larger is not.
TEST(Strain, AGaugeOfAnotherAspectIsAStrain) {
  const BaseMesh mesh = make_swatch(0.04, 0.024, 6, 4);
  const Pattern tile = straining_tile(kReach);
  FabricSpec spec = strained_spec(LoopStrain::relaxed);
  spec.scale.kind = FabricScale::Kind::gauge;
  spec.scale.gauge = {1 / (1.5 * tile.period.x), 1 / (1.5 * tile.period.y)};
  const Fabric larger = knit_fabric(mesh, tile, spec, 1);
  EXPECT_EQ(larger.report.strain.least, dvec2(0));
  EXPECT_EQ(larger.report.strain.most, dvec2(0));
  spec.scale.gauge = {1 / (1.44 * tile.period.x), 1 / (1.0 * tile.period.y)};
  const Fabric wider = knit_fabric(mesh, tile, spec, 1);
  EXPECT_NEAR(wider.report.strain.least.x, 0.2, 1e-6);  // sqrt(1.44), and its inverse along wales
  EXPECT_NEAR(wider.report.strain.most.y, 1 / 1.2 - 1, 1e-6);
}

TEST(Strain, NeedsATableAndStoredPoints) {
  const BaseMesh mesh = make_swatch(0.02, 0.012, 6, 4);
  FabricSpec spec = strained_spec(LoopStrain::relaxed);
  expect_user_error([&] { knit_fabric(mesh, stockinette_pattern(0.002), spec); },
                    {"fabric 'cloth'", "no table of strains", "affine"});
  spec.lattice = 1;
  expect_user_error([&] { knit_lattice(mesh, straining_tile(kReach), spec); }, {"fabric 'cloth'", "relaxed", "stored"});
}

}  // namespace
}  // namespace wale
