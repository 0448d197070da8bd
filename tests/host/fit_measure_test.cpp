#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "geom/flat_knit.h"
#include "host/fit/cloth_measures.h"

namespace wale::fit {
namespace {

constexpr double kPi = std::numbers::pi;

// What a yarn of known make shows, and what is concluded from it.
TEST(FitMeasures, GiveTheYarnThatWasMeasured) {
  for (int plies = 2; plies <= 8; ++plies)
    for (const double pitch : {3.0, 8.0, 25.0}) {
      const double radius = 0.6e-3;
      YarnSpec spec;
      spec.plies = plies;
      fill_yarn(spec, radius);
      ClothMeasures m;
      m.wale = 2.5e-3;
      m.course = 1.6e-3;
      m.yarn = 2 * radius;
      m.ply = 2 * spec.ply_radius;
      m.angle = std::atan(2 * kPi * spec.helix_radius / (pitch * radius));
      const ClothParameters p = cloth_parameters(m, 0.5e-3, {});
      EXPECT_NEAR(*p.wales, 40, 1e-9);
      EXPECT_NEAR(*p.courses, 62.5, 1e-9);
      EXPECT_NEAR(*p.thickness, 1.2, 1e-12);
      EXPECT_EQ(*p.plies, plies);
      EXPECT_FALSE(p.ply_radius);
      EXPECT_NEAR(*p.twist_pitch, pitch, 1e-9 * pitch);
    }
}

TEST(FitMeasures, PliesThatPressIntoEachOtherKeepTheirSize) {
  ClothMeasures m;
  m.yarn = 1e-3;
  m.ply = 0.55e-3;
  m.plies = 3;
  const ClothParameters p = cloth_parameters(m, 0.5e-3, {});
  ASSERT_TRUE(p.ply_radius);
  EXPECT_DOUBLE_EQ(*p.ply_radius, 0.275e-3);
  ASSERT_EQ(p.notes.size(), 1u);
  EXPECT_NE(p.notes[0].find("press into each other"), std::string::npos) << p.notes[0];
}

TEST(FitMeasures, LeftHandedPliesHaveANegativePitch) {
  ClothMeasures m;
  m.angle = -20 * kPi / 180;
  const ClothParameters p = cloth_parameters(m, 0.5e-3, {2, 8});
  EXPECT_NEAR(*p.twist_pitch, -2 * kPi * 0.5 / std::tan(20 * kPi / 180), 1e-9);
  EXPECT_FALSE(p.thickness);
  EXPECT_FALSE(p.wales);
}

}  // namespace
}  // namespace wale::fit
