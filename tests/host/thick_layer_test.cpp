// From the colour of cloth to the colour of its fibres.
#include "host/thick_layer.h"

#include <gtest/gtest.h>

#include <cmath>

#include "host/materials.h"

namespace wale {
namespace {

PlyAppearance preset(const std::string& name) {
  PlyAppearance a;
  a.preset = name;
  return a;
}

TEST(ThickLayer, ColourRisesWithTheFibres) {
  for (const std::string& name : ply_presets()) {
    const ThickLayer layer(ply_material(preset(name)));
    double before = -1;
    for (int i = 0; i <= 1000; ++i) {
      const double seen = layer.seen(i / 1000.0);
      EXPECT_GT(seen, before) << name << " " << i;
      before = seen;
    }
    EXPECT_EQ(layer.seen(1), 1) << name;
    EXPECT_EQ(layer.albedo(1), 1) << name;
    EXPECT_LT(layer.seen(0), 0.03) << name << ": black fibres look black";
    EXPECT_GT(layer.mean_cosine(1), -0.9) << name;
    EXPECT_LT(layer.mean_cosine(1), 0.9) << name;
  }
}

TEST(ThickLayer, FibreColourIsTheInverse) {
  for (const std::string& name : ply_presets()) {
    const ThickLayer layer(ply_material(preset(name)));
    EXPECT_EQ(layer.fibre(1), 1);
    EXPECT_EQ(layer.fibre(0), 0);
    double before = -1;
    for (int i = 0; i <= 200; ++i) {
      const double seen = i / 200.0, fibre = layer.fibre(seen);
      EXPECT_GE(fibre, before);
      before = fibre;
      if (seen > layer.seen(0)) {
        EXPECT_NEAR(layer.seen(fibre), seen, 1e-7) << name;
      }
    }
  }
}

/// Share of diffuse light that a semi-infinite, isotropically scattering medium of albedo a gives back:
/// 1 - 2 sqrt(1-a) int H(mu) mu dmu, H by iteration (Chandrasekhar, Radiative Transfer, chapter V).
double isotropic_albedo(double a) {
  constexpr int kSteps = 200;
  std::vector<double> h(kSteps, 1.0);
  const auto mu = [](int i) { return (i + 0.5) / kSteps; };
  const double root = std::sqrt(1 - a);
  for (int round = 0; round < 200; ++round) {
    std::vector<double> next(kSteps);
    for (int i = 0; i < kSteps; ++i) {
      double sum = 0;
      for (int j = 0; j < kSteps; ++j) sum += mu(j) * h[j] / (mu(i) + mu(j)) / kSteps;
      next[i] = 1 / (root + 0.5 * a * sum);
    }
    h = next;
  }
  double moment = 0;
  for (int i = 0; i < kSteps; ++i) moment += mu(i) * h[i] / kSteps;
  return 1 - 2 * root * moment;
}

// By similarity a medium (A, g) looks like the isotropic one with the same (1-A)/(1-A g): exact at g = 0.
TEST(ThickLayer, IsTheSemiInfiniteMedium) {
  const ThickLayer layer(ply_material(preset("wool")));
  for (const double fibre : {0.0, 0.5, 0.9, 0.98, 0.998}) {
    const double a = layer.albedo(fibre), same = 1 - (1 - a) / (1 - a * layer.mean_cosine(fibre));
    EXPECT_NEAR(layer.seen(fibre), isotropic_albedo(same), 0.004) << fibre;  // van de Hulst's fit, and the grid
  }
}

TEST(ThickLayer, MaterialsTakeTheirColourThroughIt) {
  PlyAppearance a = preset("cotton");
  a.color = Rgb{0, 0.4, 1};
  const WPlyMaterial m = ply_material(a);
  EXPECT_EQ(m.fibre.x, 0);
  EXPECT_EQ(m.fibre.z, 1);
  const ThickLayer layer(m);
  EXPECT_NEAR(layer.seen(m.fibre.y), 0.4, 1e-5);
  // The cloth keeps its colour whatever its density and gloss.
  for (const double t : {0.0, 1.0}) {
    a.translucency = t;
    a.gloss = t;
    const WPlyMaterial other = ply_material(a);
    EXPECT_NEAR(ThickLayer(other).seen(other.fibre.y), 0.4, 1e-5);
    EXPECT_NE(other.fibre.y, m.fibre.y);
  }
}

}  // namespace
}  // namespace wale
