// Noise of a tile and what is decided by it.
#include "host/tile_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "host/error_goal.h"
#include "tests/tolerances.h"

namespace wale::test {
namespace {

using Sums = std::vector<w_float4>;
constexpr size_t kValues = kTilePixels * kScrambles;

w_float4 grey(double value, double samples) { return {float(value), float(value), float(value), float(samples)}; }

Sums tile_of(const std::function<w_float4(size_t pixel, size_t scramble)>& value) {
  Sums sums;
  for (size_t p = 0; p < kTilePixels; ++p)
    for (size_t g = 0; g < kScrambles; ++g) sums.push_back(value(p, g));
  return sums;
}

// Samples of mean 1 and variance 1, `counts` of them per scramble.
Sums exponential(std::mt19937& random, const std::vector<int>& counts) {
  std::exponential_distribution<double> draw(1);
  return tile_of([&](size_t, size_t g) {
    double sum = 0;
    for (int k = 0; k < counts[g]; ++k) sum += draw(random);
    return grey(sum, counts[g]);
  });
}

TEST(TileError, OfTwoKindsOfScrambles) {
  // Means of 0.75 and 1.25, two samples each: the variance of the mean is 0.25^2 / 7.
  const Sums sums = tile_of([](size_t, size_t g) { return grey(g % 2 ? 2.5 : 1.5, 2); });
  EXPECT_NEAR(tile_error(sums, 0), 0.25 / std::sqrt(7), 1e-7);
  EXPECT_NEAR(tile_error(sums, 10), 0.025 / std::sqrt(7), 1e-8) << "against the floor";
  EXPECT_NEAR(tile_luminance(sums), 1, 1e-6);
}

TEST(TileError, IsLuminancesNotAChannels) {
  // Red and green noise that cancel in luminance.
  const Sums sums = tile_of([](size_t, size_t g) {
    const float d = g % 2 ? 0.1f : -0.1f;
    return w_float4{1 + d / 0.2126f, 1 - d / 0.7152f, 1, 1};
  });
  EXPECT_LT(tile_error(sums, 0), 1e-6);
}

TEST(TileError, ExpectedValueIsTheStandardError) {
  std::mt19937 random(11);
  for (const auto& counts :
       {std::vector<int>(8, 40), {42, 42, 42, 41, 41, 41, 41, 41}, {90, 90, 90, 90, 10, 10, 10, 10}}) {
    double sum = 0, samples = 0;
    for (const int n : counts) samples += n;
    constexpr int kTiles = 300;
    for (int i = 0; i < kTiles; ++i) sum += std::pow(tile_error(exponential(random, counts), 0), 2) / kTiles;
    EXPECT_NEAR(sum * samples, 1, tolerance::kErrorOfError) << counts[0];
  }
}

TEST(TileError, NothingIsKnownOfOneScrambleOrOfNone) {
  EXPECT_TRUE(std::isinf(tile_error(tile_of([](size_t, size_t g) { return grey(1, g == 0); }), 0.1)));
  EXPECT_TRUE(std::isinf(tile_error(tile_of([](size_t, size_t) { return grey(0, 0); }), 0.1)));
  const auto one_pixel_short = [](size_t p, size_t g) { return grey(1, p == 7 ? g == 3 : 1); };
  EXPECT_TRUE(std::isinf(tile_error(tile_of(one_pixel_short), 0.1)));
}

TEST(TileError, BlackAndAbsentPixels) {
  EXPECT_EQ(tile_error(tile_of([](size_t, size_t) { return grey(0, 4); }), 0), 0);
  const auto noisy = [](size_t g) { return grey(g % 2 ? 1.5 : 0.5, 1); };
  const double full = tile_error(tile_of([&](size_t, size_t g) { return noisy(g); }), 0);
  const double border = tile_error(tile_of([&](size_t p, size_t g) { return p % 8 < 3 ? noisy(g) : grey(0, 0); }), 0);
  const double half = tile_error(tile_of([&](size_t p, size_t g) { return p % 2 ? noisy(g) : grey(0, 1); }), 0);
  EXPECT_NEAR(border, full, 1e-9) << "pixels outside of the picture do not count";
  EXPECT_NEAR(half, full / std::sqrt(2), 1e-9) << "black ones do";
}

TEST(ErrorFloor, IsATwentiethOfTheMeanWithoutTheBrightest) {
  std::vector<double> tiles(40, 1.0);
  tiles[3] = tiles[30] = 1e6;  // a light
  EXPECT_NEAR(error_floor(tiles), 0.05, 1e-12);
  tiles[5] = 1e6;
  EXPECT_GT(error_floor(tiles), 1000) << "more than a twentieth of the picture belongs to it";
  EXPECT_EQ(error_floor(std::vector<double>(9, 0.0)), 0);
}

TEST(ErrorGoal, Checkpoints) {
  std::vector<uint32_t> all;
  for (uint32_t n = 0; n < 1000;) all.push_back(n = next_checkpoint(n, 1000));
  EXPECT_EQ(all, (std::vector<uint32_t>{16, 24, 32, 48, 64, 96, 128, 192, 256, 384, 512, 768, 1000}));
  EXPECT_EQ(next_checkpoint(0, 8), 8u);
}

TEST(ErrorGoal, TilesStopOneByOne) {
  ErrorGoal goal(0.1, 32, 4);
  EXPECT_EQ(goal.open(), (std::vector<uint32_t>{0, 1, 2, 3}));
  EXPECT_EQ(goal.checkpoint(), 16u);
  goal.judge({0.2, 0.1, 0, 0.12});
  EXPECT_EQ(goal.open(), (std::vector<uint32_t>{0, 3}));
  EXPECT_EQ(goal.checkpoint(), 24u);
  EXPECT_NEAR(goal.expected(), (32 - 16) + (16 * 1.44 - 16), 1e-9) << "no more than the limit";
  goal.judge({0.18, 0.09});
  EXPECT_EQ(goal.open(), std::vector<uint32_t>{0});
  EXPECT_EQ(goal.checkpoint(), 32u);
  goal.judge({0.15});
  EXPECT_TRUE(goal.open().empty()) << "the limit";
}

TEST(Reached, OfTheTiles) {
  std::vector<double> errors;
  std::vector<uint32_t> samples;
  for (int i = 100; i > 0; --i) errors.push_back(0.01 * i), samples.push_back(i > 90 ? 64 : 16);
  const Reached r = reached(errors, samples, 0.9, 0.02);
  EXPECT_DOUBLE_EQ(r.worst, 1);
  EXPECT_DOUBLE_EQ(r.p95, 0.95);
  EXPECT_DOUBLE_EQ(r.median, 0.5);
  EXPECT_EQ(r.missed, 10u);
  EXPECT_EQ(r.tiles, 100u);
  EXPECT_EQ(r.least, 16u);
  EXPECT_EQ(r.most, 64u);
  EXPECT_DOUBLE_EQ(r.mean, 20.8);
  EXPECT_EQ(reached({0.5}, {8}, 0, 0).missed, 0u) << "no goal, none missed";
}

}  // namespace
}  // namespace wale::test
