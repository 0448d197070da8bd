// Materials: presets, overrides, refusal of values out of range.
#include "host/materials.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geom/error.h"
#include "host/scattering_keys.h"

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

template <typename Change>
std::string refusal(const Change& change) {
  PlyAppearance a;
  change(a);
  try {
    fibre_recipe(a);
    fibre_material(a);
  } catch (const Error& e) {
    EXPECT_EQ(e.fault(), Fault::user);
    return e.what();
  }
  return "";
}

TEST(Materials, GlossNarrowsTheHighlight) {
  for (const std::string& name : ply_presets()) {
    PlyAppearance a;
    a.preset = name;
    const float own = ply_material(a).beta_r;
    a.gloss = 0.5;
    EXPECT_FLOAT_EQ(ply_material(a).beta_r, own) << name;
    float before = 10;
    for (int i = 0; i <= 20; ++i) {
      a.gloss = i / 20.0;
      const float beta = ply_material(a).beta_r;
      EXPECT_LE(beta, before);
      EXPECT_GE(beta, 0.5 * M_PI / 180 * 0.99999);
      EXPECT_LE(beta, 40 * M_PI / 180 * 1.00001);
      before = beta;
    }
    EXPECT_LT(before, own / 5);
  }
}

TEST(Materials, TranslucencyThinsThePly) {
  PlyAppearance a;
  const WPlyMaterial own = ply_material(a);
  a.translucency = 0.5;
  EXPECT_FLOAT_EQ(ply_material(a).tau_e, own.tau_e);
  EXPECT_FLOAT_EQ(ply_material(a).b, own.b);
  float tau = 1e9f, b = 1e9f;
  for (int i = 0; i <= 20; ++i) {
    a.translucency = i / 20.0;
    const WPlyMaterial m = ply_material(a);
    EXPECT_LT(m.tau_e, tau);
    EXPECT_LT(m.b, b);
    tau = m.tau_e, b = m.b;
  }
}

TEST(Materials, FittedParametersReplaceThePresets) {
  PlyAppearance a;
  int i = 0;
  for (const ScatteringKey& k : kScatteringKeys) a.scattering.*k.given = 0.51 + 0.01 * i++;
  const WPlyMaterial m = ply_material(a);
  i = 0;
  for (const ScatteringKey& k : kScatteringKeys) EXPECT_FLOAT_EQ(m.*k.value, float(0.51 + 0.01 * i++)) << k.key;
}

TEST(Materials, FibresReplaceThePresets) {
  PlyAppearance a;
  a.fibre_twist = 0.3;
  EXPECT_NEAR(fibre_recipe(a).twist, std::tan(0.3), 1e-6);
  a.fibres = {40, 0.6, -0.4, 1.5, 0.2, 0.7, 2.5, 9, 0.11, 0.22};
  const FibreRecipe r = fibre_recipe(a);
  EXPECT_EQ(r.fibres, 40);
  EXPECT_EQ(r.packing, 0.6);
  EXPECT_NEAR(r.twist, std::tan(-0.4), 1e-6) << "its sign is the sense";
  EXPECT_EQ(r.radial_beta, 1.5);
  EXPECT_EQ(r.radial_epsilon, 0.2);
  EXPECT_EQ(r.migration_min, 0.7);
  EXPECT_EQ(r.migration_rate, 2.5);
  EXPECT_EQ(r.seed, 9u);
  EXPECT_FLOAT_EQ(fibre_material(a).beta_tt, 0.11f);
  EXPECT_FLOAT_EQ(fibre_material(a).gamma_tt, 0.22f);
}

TEST(Materials, RefusesWhatExcludesEachOther) {
  const Rgb grey{0.5, 0.5, 0.5};
  EXPECT_NE(refusal([&](auto& a) { a.color = a.fibre_color = grey; }), "");
  EXPECT_NE(refusal([&](auto& a) { a.color = a.forward = a.back = grey; }), "");
  EXPECT_NE(refusal([](auto& a) { a.gloss = a.roughness = 0.5; }), "");
  EXPECT_NE(refusal([](auto& a) { a.translucency = a.optical_radius = 0.5; }), "");
  EXPECT_NE(refusal([](auto& a) { a.translucency = a.scattering.optical_radius = 0.5; }), "");
  EXPECT_NE(refusal([](auto& a) { a.optical_radius = a.scattering.optical_radius = 0.5; }), "");
  EXPECT_EQ(refusal([](auto& a) { a.translucency = a.gloss = 0.5; }), "");
}

TEST(Materials, RefusesOutOfRangeWithTheRange) {
  EXPECT_NE(refusal([](auto& a) { a.fibres.count = 0; }).find("1 to 4096"), std::string::npos);
  EXPECT_NE(refusal([](auto& a) { a.fibres.packing = 0.71; }).find("up to 0.7"), std::string::npos);
  EXPECT_NE(refusal([](auto& a) { a.fibres.packing = 0.0; }).find("above 0"), std::string::npos);
  EXPECT_NE(refusal([](auto& a) { a.fibre_twist = 89.0 * M_PI / 180; }).find("below 1.55"), std::string::npos);
  EXPECT_NE(refusal([](auto& a) { a.fibres.twist = -1.57; }), "");
  EXPECT_NE(refusal([](auto& a) { a.gloss = 1.1; }), "");
  EXPECT_NE(refusal([](auto& a) { a.translucency = -0.1; }), "");
  EXPECT_NE(refusal([](auto& a) { a.ior = 0.9; }), "");
  EXPECT_NE(refusal([](auto& a) { a.scattering.variance_edge = 0.0; }), "");
  EXPECT_NE(refusal([](auto& a) { a.fibre_color = Rgb{0, -0.1, 0}; }), "");
}

// Body colours say what many fibres do together: single fibres are brighter, white ones white.
TEST(Materials, FibresOfBodyColours) {
  PlyAppearance look;
  look.forward = Rgb{1, 0.6, 0.1};
  look.back = Rgb{1, 0.4, 0.1};
  const WFibreMaterial fibre = fibre_material(look);
  EXPECT_EQ(fibre.transmit.x, 1);
  EXPECT_GT(fibre.transmit.y, 0.6f);
  EXPECT_LT(fibre.transmit.y, 1.0f);
  EXPECT_LT(fibre.transmit.z, fibre.transmit.y);
  EXPECT_EQ(fibre.transmit.w, 1);
  look.forward = look.back = std::nullopt;
  EXPECT_EQ(fibre_material(look).transmit.w, 0);
}

}  // namespace
}  // namespace wale
