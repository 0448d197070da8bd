// White furnace of the whole renderer: white fibres in a constant environment of radiance 1 look like nothing at all,
// at any number of bounces. Energy that is lost, counted twice or sampled with a wrong density shows.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "tests/image/picture.h"

namespace wale::test {
namespace {

constexpr Rgb kWhite{1, 1, 1};

Scene one_ply(int pixels) {
  Scene scene = empty_scene(0.002, pixels);
  add_fabric(scene, straight_yarn(0.002, 0.0005), 0.006, 0.002, 1, "wool", kWhite);
  return scene;
}

Scene three_ply_yarn(int pixels) {
  Scene scene = empty_scene(0.002, pixels);
  add_fabric(scene, straight_yarn(0.002, 0.0007), 0.006, 0.002, 3, "cotton", kWhite);
  return scene;
}

Scene swatch(int pixels) {
  Scene scene = empty_scene(0.006, pixels);
  add_fabric(scene, stockinette_pattern(), 0.012, 0.012, 3, "silk", kWhite);
  return scene;
}

struct Case {
  const char* name;
  Scene (*scene)(int pixels);
  const char* light_sampling;
  int pixels, spp;  ///< so many that 0.2 % is at least three standard errors of the mean
};

class WhiteFurnace : public testing::TestWithParam<Case> {};

void expect_furnace(const Case& c) {
  Scene scene = c.scene(c.pixels);
  scene.lights.push_back(constant_environment(1));
  scene.integrator.light_sampling = c.light_sampling;
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const Picture picture = take(scene, c.spp, seed);
    size_t tests = 0;
    const double p = smallest_p(picture.image, 1.0, tests);
    EXPECT_GT(p, sidak(0.01, tests)) << "seed " << seed;
    for (const double mean : mean_rgb(picture.image)) EXPECT_NEAR(mean, 1.0, 0.002) << "seed " << seed;
    EXPECT_EQ(bad_events(picture.counts), 0u);
    EXPECT_GT(picture.counts.bounce, picture.counts.primary / 4) << "the fabric was not hit";
  }
}

TEST_P(WhiteFurnace, EveryPixelIsOneThreeTimes) { expect_furnace(GetParam()); }

INSTANTIATE_TEST_SUITE_P(
    All, WhiteFurnace,
    testing::Values(Case{"OnePlyMis", one_ply, "mis", 32, 512}, Case{"OnePlyLight", one_ply, "light", 16, 8192},
                    Case{"OnePlyBsdf", one_ply, "bsdf", 32, 64}, Case{"YarnMis", three_ply_yarn, "mis", 32, 512},
                    Case{"YarnLight", three_ply_yarn, "light", 16, 8192},
                    Case{"YarnBsdf", three_ply_yarn, "bsdf", 32, 64}, Case{"SwatchMis", swatch, "mis", 32, 512},
                    Case{"SwatchBsdf", swatch, "bsdf", 32, 64}),
    [](const auto& test) { return test.param.name; });

// Ten bounces and more, all of their light found by chance in the narrow lobes of silk: 0.2 % takes a hundred million
// rays.
TEST(WhiteFurnaceLong, SwatchLight) {
  const char* long_tests = std::getenv("WALE_LONG_TESTS");
  if (!long_tests || std::string(long_tests) != "1") GTEST_SKIP() << "long test: ./wale test --long";
  expect_furnace({"SwatchLight", swatch, "light", 16, 32768});
}

// The part of it that fits a short run: a smaller sample, judged by its own error.
TEST(WhiteFurnaceShort, SwatchByLightSamplingIsOneWithinItsError) {
  Scene scene = swatch(16);
  scene.lights.push_back(constant_environment(1));
  scene.integrator.light_sampling = "light";
  const Image image = take(scene, 8192, 4).image;
  size_t tests = 0;
  const double p = smallest_p(image, 1.0, tests);
  EXPECT_GT(p, sidak(0.01, tests));
  double variance = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) variance += image.at(x, y)[4];
  const double error = std::sqrt(variance) / (image.width * image.height);
  EXPECT_LT(error, 0.0016);
  EXPECT_NEAR(mean_rgb(image)[1], 1.0, 3 * error);
}

// The channel that fibres keep must not be noisier for being one that the eye sees badly.
TEST(ColouredFurnace, BlueFibresAreNoNoisierThanGreenOnes) {
  double variance[3] = {};
  for (int c = 0; c < 3; ++c) {
    Scene scene = swatch(32);
    Rgb color{0, 0, 0};
    color[size_t(c)] = 1;
    scene.materials[0].yarn.color = color;
    scene.lights.push_back(constant_environment(1));
    const Image image = take(scene, 64, 1).image;
    EXPECT_NEAR(mean_rgb(image)[size_t(c)], 1.0, 0.005) << c;
    EXPECT_LT(mean_rgb(image)[size_t((c + 1) % 3)], 0.5) << c;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) variance[c] += image.at(x, y)[3 + c];
  }
  EXPECT_NEAR(variance[0] / variance[1], 1, 0.1);
  EXPECT_NEAR(variance[2] / variance[1], 1, 0.1);
}

}  // namespace
}  // namespace wale::test
