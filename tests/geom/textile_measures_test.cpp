// Textile figures of fabrics that can be worked out by hand: straight yarns in a row.
#include "geom/textile_measures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace wale {
namespace {

Pattern straight(double length, double pitch, double radius) {
  Pattern p;
  p.name = "straight";
  p.period = {length, pitch};
  p.yarn_radius = radius;
  p.stitches = {1, 1};
  PatternCurve curve;
  for (int i = 0; i <= 4; ++i) curve.points.push_back({length * i / 4, 0.3 * pitch, 0});
  p.curves.push_back(curve);
  return p;
}

YarnSpec yarn_of(int plies, double radius, double turns_per_metre) {
  YarnSpec yarn;
  yarn.plies = plies;
  yarn.twist = turns_per_metre;
  fill_yarn(yarn, radius);
  return yarn;
}

constexpr double kPi = std::numbers::pi;

TEST(TextileMeasures, OneStraightPly) {
  // Yarns of radius 0.25 mm every 1.2 mm, 3 mm a stitch: a cylinder of fibre, packed to one half.
  const TextileMeasures m =
      measure_textile(straight(0.003, 0.0012, 0.00025), yarn_of(1, 0.00025, 0), {0.003, 0.0012}, {1310, 0.5});
  const double kg_per_metre = 1310 * 0.5 * kPi * 0.00025 * 0.00025;
  EXPECT_NEAR(m.yarn_per_stitch, 0.003, 1e-9);
  EXPECT_NEAR(m.ply_per_yarn, 1, 1e-9);
  EXPECT_NEAR(m.tex(), 1e6 * kg_per_metre, 1e-6 * m.tex());
  EXPECT_NEAR(m.area_mass, kg_per_metre / 0.0012, 1e-6 * m.area_mass);
  EXPECT_NEAR(m.tightness(), std::sqrt(1e6 * kg_per_metre) / 0.3, 1e-6 * m.tightness());
  EXPECT_NEAR(m.cover, 0.5 / 1.2, 0.003);  // a raster of 256 points a tile
}

TEST(TextileMeasures, YarnsThatOverlapCoverOnce) {
  const TextileMeasures m =
      measure_textile(straight(0.003, 0.0012, 0.0007), yarn_of(1, 0.0007, 0), {0.003, 0.0012}, {});
  EXPECT_EQ(m.cover, 1);
}

// A tile that is stretched on the cloth: lengths follow the cloth, not the pattern.
TEST(TextileMeasures, MeasuresAreOfTheCloth) {
  const TextileMeasures m =
      measure_textile(straight(0.003, 0.0012, 0.00025), yarn_of(1, 0.0005, 0), {0.006, 0.0036}, {1540, 0.6});
  EXPECT_NEAR(m.yarn_per_stitch, 0.006, 1e-9);
  EXPECT_NEAR(m.cover, 1.0 / 3.6, 0.003);
  EXPECT_NEAR(m.area_mass, 1540 * 0.6 * kPi * 0.0005 * 0.0005 / 0.0036, 1e-5);
}

// Plies on a helix are longer than their yarn by sqrt(1 + (2 pi r t)^2).
TEST(TextileMeasures, TwistTakesUpPlies) {
  const YarnSpec yarn = yarn_of(2, 0.0004, 300);
  const TextileMeasures m = measure_textile(straight(0.003, 0.002, 0.0004), yarn, {0.003, 0.002}, {1310, 0.4});
  const double take_up = std::sqrt(1 + std::pow(2 * kPi * yarn.helix_radius * 300, 2));
  ASSERT_GT(take_up, 1.05);
  EXPECT_NEAR(m.ply_per_yarn, take_up, 1e-3 * take_up);
  EXPECT_NEAR(m.yarn_mass, 1310 * 0.4 * 2 * kPi * yarn.ply_radius * yarn.ply_radius * take_up, 1e-3 * m.yarn_mass);
  // Two touching circles on a helix hide a width of 2 r (1 + |cos a|), a the angle, uniform along the yarn.
  const double width = 2 * yarn.ply_radius * (1 + 2 / kPi);
  EXPECT_NEAR(m.cover, width / 0.002, 0.01);
}

// Stitches are those of the pattern; a knitted yarn is longer than its course is wide.
TEST(TextileMeasures, StockinetteLoops) {
  const Pattern tile = stockinette_pattern();
  YarnSpec yarn = yarn_of(3, tile.yarn_radius, 0);
  const TextileMeasures m = measure_textile(tile, yarn, tile.period, {1310, 0.4});
  double polyline = 0;
  const auto& points = tile.curves[0].points;
  for (size_t i = 0; i + 1 < points.size(); ++i) polyline += glm::distance(points[i], points[i + 1]);
  EXPECT_NEAR(m.yarn_per_stitch, polyline, 0.005 * polyline);
  EXPECT_GT(m.yarn_per_stitch, polyline);  // chords are shorter than the curve
  EXPECT_GT(m.cover, 0.5);
  EXPECT_LT(m.cover, 1);
}

}  // namespace
}  // namespace wale
