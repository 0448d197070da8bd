// Environment light: orientation, lookup, samples against density, constant radiance.
#include <gtest/gtest.h>

#include "tests/kernels/light_kernels.h"
#include "tests/tolerances.h"

namespace wale {
namespace {
using namespace test;

constexpr int kWidth = 16, kHeight = 8;

std::vector<float> random_image(uint32_t seed) {
  Random random(seed);
  std::vector<float> rgb;
  for (int i = 0; i < kWidth * kHeight; ++i) {
    const bool black = random.uniform() < 0.3;
    for (int k = 0; k < 3; ++k) rgb.push_back(black ? 0 : float(std::pow(random.uniform(), 4) * 10));
  }
  rgb[3 * (2 * kWidth + 5) + 2] = 400;  // a small blue sun
  return rgb;
}

struct ImageLight {
  EnvironmentTables image;
  WEnvironment environment;
  LightScene scene;
};

ImageLight image_light(const std::vector<float>& rgb, bool turned) {
  EnvironmentTables image = environment_tables(rgb, kWidth, kHeight);
  WEnvironment e = no_environment();
  e.radiance.w = 1;
  e.width = kWidth;
  e.height = kHeight;
  e.average = image.average;
  e.light = 0;
  if (turned) {  // 90 degrees about z, then about x
    e.to_local[0] = {0, 1, 0, 0};
    e.to_local[1] = {0, 0, 1, 0};
    e.to_local[2] = {1, 0, 0, 0};
  }
  LightTableBuilder builder;
  builder.add_environment({1, 1, 1}, 1);
  return {image, e, LightScene(builder.finish(), e, image)};
}

std::vector<double> lookup(const LightScene& scene, const std::vector<float>& directions) {
  return scene.run("environment", directions.size() / 3, 4, scene.runner().upload(directions));
}

TEST(Environment, OrientationIsAsDocumented) {
  // Row 0 bright: up. Then single columns.
  std::vector<float> rgb(kWidth * kHeight * 3, 0);
  for (int x = 0; x < kWidth; ++x) rgb[3 * x] = 1;
  const int middle = kHeight / 2;
  for (int y = middle - 1; y <= middle; ++y) {
    for (const int x : {7, 8}) rgb[3 * (y * kWidth + x)] = 2;    // -z: middle of the image
    for (const int x : {11, 12}) rgb[3 * (y * kWidth + x)] = 3;  // +x: three quarters
    for (const int x : {0, 15}) rgb[3 * (y * kWidth + x)] = 4;   // +z: the border, wrapped
    for (const int x : {3, 4}) rgb[3 * (y * kWidth + x)] = 5;    // -x: one quarter
  }
  const ImageLight light = image_light(rgb, false);
  const auto out = lookup(light.scene, {0, 1, 0, 0, 0, -1, 1, 0, 0, 0, 0, 1, -1, 0, 0, 0, -1, 0});
  const std::vector<double> expected = {1, 2, 3, 4, 5, 0};
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(out[4 * i + 1], expected[i], 1e-5) << i;
}

TEST(Environment, SamplesFollowDensity) {
  for (const bool turned : {false, true}) {
    const ImageLight light = image_light(random_image(3), turned);
    Random random(12);
    constexpr size_t kCount = 400000;
    std::vector<float> u(4 * kCount);
    for (float& v : u) v = random.uniform_float();
    const auto samples = light.scene.samples({0, 0, 0}, u);
    // Cells of (world z, azimuth), finer than texels are; expectation from the density on a subgrid.
    constexpr int kBins = 24, kSub = 24, kSide = kBins * kSub;
    std::vector<float> directions;
    for (int i = 0; i < kSide * kSide; ++i) {
      const double z = 2 * (i / kSide + 0.5) / kSide - 1, phi = 2 * M_PI * (i % kSide + 0.5) / kSide;
      for (const double v : {std::sqrt(1 - z * z) * std::cos(phi), std::sqrt(1 - z * z) * std::sin(phi), z})
        directions.push_back(float(v));
    }
    const auto density = lookup(light.scene, directions);
    std::vector<double> expected(kBins * kBins, 0), counts(kBins * kBins, 0);
    double total = 0;
    for (int i = 0; i < kSide * kSide; ++i) {
      const double share = density[4 * i] * 4 * M_PI / (double(kSide) * kSide);
      expected[(i / kSide / kSub) * kBins + i % kSide / kSub] += share;
      total += share;
    }
    EXPECT_NEAR(total, 1, 5e-3);
    for (double& e : expected) e *= kCount / total;
    double distance = 0;
    for (size_t i = 0; i < kCount; ++i) {
      const double* s = &samples[9 * i];
      const double around = std::atan2(s[1], s[0]) / (2 * M_PI);
      counts[std::clamp(int((s[2] + 1) / 2 * kBins), 0, kBins - 1) * kBins +
             std::clamp(int((around < 0 ? around + 1 : around) * kBins), 0, kBins - 1)] += 1;
    }
    for (size_t i = 0; i < counts.size(); ++i) distance += 0.5 * std::abs(counts[i] - expected[i]) / kCount;
    EXPECT_LT(distance, 0.02) << turned;
  }
}

TEST(Environment, TexelsAreChosenByTheirWeight) {
  const ImageLight light = image_light(random_image(3), false);
  Random random(13);
  constexpr size_t kCount = 400000;
  std::vector<float> u(4 * kCount);
  for (float& v : u) v = random.uniform_float();
  const auto samples = light.scene.samples({0, 0, 0}, u);
  std::vector<double> counts(kWidth * kHeight * 4, 0), expected(kWidth * kHeight * 4, 0);
  for (size_t i = 0; i < kCount; ++i) {
    const double* s = &samples[9 * i];
    const double across = (0.5 + std::atan2(s[0], -s[2]) / (2 * M_PI)) * kWidth;
    const double down = std::acos(std::clamp(s[1], -1.0, 1.0)) / M_PI * kHeight;
    const int x = std::clamp(int(across), 0, kWidth - 1), y = std::clamp(int(down), 0, kHeight - 1);
    // Four parts of each texel, equal in solid angle, see that samples are uniform within it.
    const double c0 = std::cos(M_PI * y / kHeight), c1 = std::cos(M_PI * (y + 1) / kHeight);
    const int part = (across - x > 0.5 ? 1 : 0) + ((c0 - s[1]) / (c0 - c1) > 0.5 ? 2 : 0);
    counts[(y * kWidth + x) * 4 + part] += 1;
  }
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      for (int part = 0; part < 4; ++part)
        expected[(y * kWidth + x) * 4 + part] =
            kCount / 4.0 * light.image.texels[y * kWidth + x].w / light.image.average *
            (std::cos(M_PI * y / kHeight) - std::cos(M_PI * (y + 1) / kHeight)) / (2 * kWidth);
  EXPECT_GT(chi_squared_p(counts, expected), tolerance::kFamilyP);
}

TEST(Environment, EstimatesTheIntegralOfTheLookup) {
  const ImageLight light = image_light(random_image(3), true);
  const auto samples = light.scene.samples({0, 0, 0}, spread_numbers(1 << 18));
  const double estimated = estimate(samples, [](dvec3, dvec3 radiance) { return radiance.x + radiance.z; });
  constexpr int kSide = 1024;
  std::vector<float> directions;
  for (int i = 0; i < kSide * kSide; ++i) {
    const double z = 2 * (i / kSide + 0.5) / kSide - 1, phi = 2 * M_PI * (i % kSide + 0.5) / kSide;
    for (const double v : {std::sqrt(1 - z * z) * std::cos(phi), std::sqrt(1 - z * z) * std::sin(phi), z})
      directions.push_back(float(v));
  }
  const auto out = lookup(light.scene, directions);
  double exact = 0, dark_with_light = 0;
  for (int i = 0; i < kSide * kSide; ++i) {
    exact += (out[4 * i + 1] + out[4 * i + 3]) * 4 * M_PI / (double(kSide) * kSide);
    dark_with_light += out[4 * i] <= 0 && out[4 * i + 3] > 0;
  }
  EXPECT_NEAR(estimated / exact, 1, tolerance::kFormFactor);
  EXPECT_EQ(dark_with_light, 0);
}

TEST(Environment, ConstantIsTheUniformSphere) {
  LightTableBuilder builder;
  builder.add_environment({2, 2, 2}, 1);
  WEnvironment e = no_environment();
  e.radiance = {2, 2, 2, 1};
  e.light = 0;
  const LightScene scene(builder.finish(), e, {});
  const auto samples = scene.samples({0, 0, 0}, spread_numbers(1 << 16));
  const double total = estimate(samples, [](dvec3 d, dvec3 l) { return l.x * std::max(0.0, d.y); });
  EXPECT_NEAR(total / (2 * M_PI), 1, tolerance::kFormFactor);
  EXPECT_NEAR(samples[7], 1 / (4 * M_PI), 1e-7);
  EXPECT_GT(samples[3], 1e29);
}

TEST(Environment, BlackImageIsNeverSampled) {
  const ImageLight light = image_light(std::vector<float>(kWidth * kHeight * 3, 0), false);
  for (const auto samples = light.scene.samples({0, 0, 0}, spread_numbers(64)); const double v : samples)
    EXPECT_TRUE(std::isfinite(v));
  EXPECT_EQ(light.image.average, 0);
  EXPECT_EQ(light.scene.samples({0, 0, 0}, spread_numbers(64))[7], 0);
}

}  // namespace
}  // namespace wale
