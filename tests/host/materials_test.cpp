// Materials: presets, overrides, refusal of values out of range.
#include "host/materials.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geom/error.h"

namespace wale {
namespace {

TEST(Materials, PresetsAreBoundedAndDifferent) {
  EXPECT_EQ(ply_presets(), (std::vector<std::string>{"cotton", "wool", "silk", "polyester", "acrylic", "mohair"}));
  for (const std::string& name : ply_presets()) {
    PlyAppearance a;
    a.preset = name;
    const WPlyMaterial m = ply_material(a);
    EXPECT_GT(m.tau_e, 1.5);
    EXPECT_GT(m.v_c, m.v_e);
    EXPECT_GT(m.v_e, 0.02);
    EXPECT_EQ(m.fibre.w, 0);
    EXPECT_LT(m.fibre.x, 1);
  }
}

TEST(Materials, OverridesReplaceThePreset) {
  PlyAppearance a;
  a.preset = "silk";
  a.ior = 1.5;
  a.roughness = 0.2;
  a.fibre_twist = -0.5;
  a.optical_radius = 1.25;
  a.forward = Rgb{0.1, 0.2, 0.3};
  a.back = Rgb{0.4, 0.5, 0.6};
  const WPlyMaterial m = ply_material(a);
  EXPECT_FLOAT_EQ(m.f0, 0.04f);
  EXPECT_FLOAT_EQ(m.beta_r, 0.2f);
  EXPECT_FLOAT_EQ(m.tilt, float(std::tan(-0.5)));
  EXPECT_FLOAT_EQ(m.tau_e, 1.25f);
  EXPECT_EQ(m.fibre.w, 1);
  EXPECT_FLOAT_EQ(m.forward.y, 0.2f);
  EXPECT_FLOAT_EQ(m.back.z, 0.6f);
}

TEST(Materials, RefusesByName) {
  PlyAppearance a;
  a.preset = "wol";
  try {
    ply_material(a);
    FAIL() << "accepted an unknown preset";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("wool"), std::string::npos);
    EXPECT_EQ(e.fault(), Fault::user);
  }
  PlyAppearance half;
  half.forward = Rgb{0.5, 0.5, 0.5};
  EXPECT_THROW(ply_material(half), Error);
  PlyAppearance bright;
  bright.color = Rgb{1.5, 0, 0};
  EXPECT_THROW(ply_material(bright), Error);
  PlyAppearance smooth;
  smooth.roughness = -0.1;
  EXPECT_THROW(ply_material(smooth), Error);
  SurfaceAppearance thin;
  thin.ior = 0.5;
  EXPECT_THROW(surface_material(thin), Error);
}

}  // namespace
}  // namespace wale
