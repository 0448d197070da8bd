// Sphere and mesh lights: irradiance against closed forms, densities of both ways to reach a light, choice by power.
#include <gtest/gtest.h>

#include "tests/kernels/light_kernels.h"
#include "tests/tolerances.h"

namespace wale {
namespace {
using namespace test;

constexpr size_t kSamples = 1 << 18;

double irradiance(const std::vector<double>& samples, dvec3 normal) {
  return estimate(samples, [&](dvec3 d, dvec3 radiance) { return radiance.x * std::max(0.0, glm::dot(d, normal)); });
}

LightScene sphere_scene(float radius, std::array<float, 3> center) {
  LightTableBuilder builder;
  builder.add_sphere({2, 2, 2}, center, radius);
  return {builder.finish(), no_environment(), {}};
}

// Quad 2a x 2b in the plane y = height, normal down.
std::vector<LightTriangle> quad(float a, float b, float height) {
  return {{-a, height, -b, a, height, -b, a, height, b}, {-a, height, -b, a, height, b, -a, height, b}};
}

TEST(SphereLight, IrradianceOutsideIsTheFormFactor) {
  for (const double distance : {1.2, 3.0, 1000.0}) {
    const LightScene scene = sphere_scene(1, {0, float(distance), 0});
    const auto samples = scene.samples({0, 0, 0}, spread_numbers(kSamples));
    const double exact = 2 * M_PI / (distance * distance);  // facing the centre: pi L (r/d)^2
    EXPECT_NEAR(irradiance(samples, {0, 1, 0}) / exact, 1, tolerance::kFormFactor) << distance;
  }
}

TEST(SphereLight, DistanceEndsOnTheNearSide) {
  const LightScene scene = sphere_scene(0.5, {1, 2, 3});
  const auto samples = scene.samples({-1, 0.5, 0}, spread_numbers(1000));
  for (size_t i = 0; i < 1000; ++i) {
    const double* s = &samples[9 * i];
    const dvec3 d(s[0], s[1], s[2]), hit = dvec3(-1, 0.5, 0) + d * s[3] - dvec3(1, 2, 3);
    EXPECT_NEAR(glm::length(hit), 0.5, 1e-3);  // at the silhouette the root is of a rounded zero
    EXPECT_LE(glm::dot(hit, d), 1e-3);
  }
}

TEST(SphereLight, InsideGivesTheWholeHemisphere) {
  const LightScene scene = sphere_scene(1, {0, 0, 0});
  const auto samples = scene.samples({0.3f, 0.4f, -0.2f}, spread_numbers(kSamples));
  EXPECT_NEAR(irradiance(samples, glm::normalize(dvec3(1, 1, 0))) / (2 * M_PI), 1, tolerance::kFormFactor);
  EXPECT_NEAR(estimate(samples, [](dvec3, dvec3) { return 1.0; }) / (4 * M_PI), 1, tolerance::kFormFactor);
}

TEST(MeshLight, IrradianceOfQuadIsTheFormFactor) {
  // Differential element below the middle of a rectangle and parallel to it (Howell's catalogue B-3, four corners).
  LightTableBuilder builder;
  builder.add_mesh({2, 2, 2}, quad(1, 0.5, 0.7f), {0, 1}, false);
  const LightScene scene(builder.finish(), no_environment(), {});
  const double a = 1 / 0.7, b = 0.5 / 0.7, ra = std::sqrt(1 + a * a), rb = std::sqrt(1 + b * b);
  const double factor = 4 / (2 * M_PI) * (a / ra * std::atan(b / ra) + b / rb * std::atan(a / rb));
  const auto samples = scene.samples({0, 0, 0}, spread_numbers(kSamples));
  EXPECT_NEAR(irradiance(samples, {0, 1, 0}) / (2 * M_PI * factor), 1, tolerance::kFormFactor);
}

TEST(MeshLight, OneSidedIsDarkBehind) {
  LightTableBuilder builder;
  builder.add_mesh({2, 2, 2}, quad(1, 1, 1), {0, 1}, true);
  const LightScene scene(builder.finish(), no_environment(), {});
  const auto u = spread_numbers(4096);
  // Corners run clockwise seen from above: the normal is -y, light goes down.
  const double below = irradiance(scene.samples({0, 0, 0}, u), {0, 1, 0});
  const double above = irradiance(scene.samples({0, 2, 0}, u), {0, -1, 0});
  EXPECT_GT(below, 1);
  EXPECT_EQ(above, 0);
}

TEST(MeshLight, TrianglesAreChosenByArea) {
  LightTableBuilder builder;
  builder.add_sphere({0, 0, 0}, {0, 0, 0}, 1);  // black: never chosen
  const float far = 50;
  builder.add_mesh(
      {1, 1, 1},
      {{0, far, 0, 1, far, 0, 0, far, 1}, {0, far, 0, 0, far, 0, 0, far, 0}, {-3, far, 0, 0, far, 0, -3, far, -3}},
      {0, 1, 2}, false);
  const LightScene scene(builder.finish(), no_environment(), {});
  const auto samples = scene.samples({0, 0, 0}, spread_numbers(kSamples));
  size_t small = 0;
  for (size_t i = 0; i < kSamples; ++i) {
    EXPECT_EQ(samples[9 * i + 8], 1);
    small += samples[9 * i] > 0;
  }
  EXPECT_NEAR(double(small) / kSamples, 0.5 / (0.5 + 4.5), 1e-3);
}

TEST(Lights, BothWaysToALightHaveTheSameDensity) {
  LightTableBuilder builder;
  builder.add_sphere({1, 1, 1}, {0, 3, 0}, 1);
  builder.add_sphere({0.1f, 0.1f, 0.1f}, {0, 0, 0}, 6);
  builder.add_mesh({3, 3, 3}, quad(1, 1, 5), {0, 1}, false);
  const LightTables tables = builder.finish();
  const LightScene scene(tables, no_environment(), {});
  const std::vector<float> point = {0.5f, 0.2f, -0.3f};
  const auto samples = scene.samples(point, spread_numbers(4096));
  std::vector<float> hits;
  std::vector<double> chosen(3, 0);
  for (size_t i = 0; i < 4096; ++i) {
    const double* s = &samples[9 * i];
    chosen[size_t(s[8])] += 1;
    for (const double v : {s[8], s[0], s[1], s[2], s[3], 0.0, -1.0, 0.0}) hits.push_back(float(v));
  }
  const auto densities = scene.run("densities", 4096, 1, scene.runner().upload(point), scene.runner().upload(hits));
  for (size_t i = 0; i < 4096; ++i)
    EXPECT_NEAR(densities[i] / samples[9 * i + 7], 1, tolerance::kDensityFloat) << samples[9 * i + 8];
  for (int light = 0; light < 3; ++light) EXPECT_NEAR(chosen[light] / 4096, tables.lights[light].radiance.w, 2e-3);
}

TEST(Lights, FloatAgreesWithDouble) {
  if (!Device::open().traits().fp64) GTEST_SKIP() << "the device has no fp64";
  LightTableBuilder builder;
  builder.add_sphere({1, 1, 1}, {0, 3, 0}, 1);
  builder.add_mesh({3, 3, 3}, quad(1, 1, 5), {0, 1}, false);
  builder.add_environment({1, 1, 1}, 1);
  WEnvironment e = no_environment();
  e.width = e.height = 2;
  e.light = 2;
  const EnvironmentTables image = environment_tables({1, 1, 1, 2, 2, 2, 3, 3, 3, 4, 4, 4}, 2, 2);
  e.average = image.average;
  const LightTables tables = builder.finish();
  const std::vector<float> point = {0.5f, 0.2f, -0.3f}, u = spread_numbers(4096);
  const auto a = LightScene(tables, e, image).samples(point, u),
             b = LightScene(tables, e, image, true).samples(point, u);
  double worst = 0;
  for (size_t i = 0; i < a.size(); ++i) worst = std::max(worst, std::abs(a[i] - b[i]) / (std::abs(b[i]) + 1e-2));
  EXPECT_LT(worst, tolerance::kDensityFloat);
  EXPECT_GT(worst, 0) << "the double build ran in float";
}

TEST(Lights, DegeneratePlacesStayFinite) {
  LightTableBuilder builder;
  builder.add_sphere({1, 1, 1}, {0, 0, 0}, 1);
  builder.add_mesh({1, 1, 1}, quad(1, 1, 0), {0, 1}, false);
  builder.add_sphere({1e6f, 1e6f, 1e6f}, {0, 0, 0}, 1e-6f);
  const LightScene scene(builder.finish(), no_environment(), {});
  std::vector<float> u;
  for (const float a : {0.0f, 0.3f, 0.6f, 0.999999f})
    for (const float b : {0.0f, 0.5f, 1 - 0x1p-24f})
      for (const float c : {0.0f, 0.5f, 1 - 0x1p-24f}) u.insert(u.end(), {a, b, c, b});
  for (const std::vector<float>& p :
       {std::vector<float>{0, 0, 0}, {1, 0, 0}, {1.0000001f, 0, 0}, {1, 0, 1}, {0, 1e-20f, 0}, {1e6f, 1e6f, 0}})
    for (const double v : scene.samples(p, u)) EXPECT_TRUE(std::isfinite(v));
}

}  // namespace
}  // namespace wale
