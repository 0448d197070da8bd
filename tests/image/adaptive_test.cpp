// Rendering to an error goal: what is reached is what was asked for, and nothing else changes.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "tests/image/actual_error.h"
#include "tests/image/picture.h"
#include "tests/image/program.h"
#include "tests/run_program.h"
#include "tests/temporary_folder.h"
#include "tests/tolerances.h"

namespace wale::test {
namespace {

constexpr size_t kSamplesChannel = 6;
constexpr double kGoal = 0.12;  // some tiles reach it at the first checkpoint, others at several later ones

Scene everything(int size) {
  const TemporaryFolder folder;
  return read_scene(folder.write("scene.json", everything_scene(size, 30)));
}

RenderOptions towards(double error, int limit = 4096) {
  RenderOptions options;
  options.error = error;
  options.spp = limit;
  return options;
}

RenderOptions equal_samples(int spp) { return towards(0, spp); }

// Pixels of a picture that have so many samples and differ in any bit from those of another.
size_t different_at(const Image& picture, float samples, const Image& other) {
  size_t differ = 0;
  const size_t stride = picture.channels.size();
  for (size_t i = 0; i < picture.pixels.size(); i += stride)
    if (picture.pixels[i + kSamplesChannel] == samples)
      differ += !std::equal(&picture.pixels[i], &picture.pixels[i] + stride, &other.pixels[i]);
  return differ;
}

TEST(Adaptive, EveryTileHasTheNextSamplesOfItsSequence) {
  const Studio studio(device(), everything(36));  // the tiles at two borders are half outside
  RenderOptions options = towards(kGoal);
  options.aovs = true;
  const Rendered adaptive = studio.take(options, 3);
  std::set<float> counts;
  for (size_t i = kSamplesChannel; i < adaptive.image.pixels.size(); i += adaptive.image.channels.size())
    counts.insert(adaptive.image.pixels[i]);
  ASSERT_GT(counts.size(), 2u);
  EXPECT_EQ(adaptive.reached.least, uint32_t(*counts.begin()));
  EXPECT_EQ(adaptive.reached.most, uint32_t(*counts.rbegin()));
  EXPECT_FALSE(adaptive.stopped);
  for (const float samples : counts) {
    options = equal_samples(int(samples));
    options.aovs = true;
    EXPECT_EQ(different_at(adaptive.image, samples, studio.take(options, 3).image), 0u) << samples;
  }
}

TEST(Adaptive, EveryPoolGivesTheSameBytes) {
  const Studio studio(device(), everything(36));
  RenderOptions options = towards(kGoal);
  const Image expected = studio.take(options, 3).image;
  EXPECT_NE(different_pixels(expected, studio.take(options, 4).image), 0u);
  for (const uint32_t pool : {65u, 1000u, 4099u}) {
    options.pool = pool;
    EXPECT_EQ(different_pixels(expected, studio.take(options, 3).image), 0u) << "pool " << pool;
  }
}

TEST(Adaptive, TwoDevicesGiveTheBytesOfOne) {
  const std::string two = "POCL_DEVICES=basic pthread";
  if (run_wale({"devices"}, {two}).out.find("1: pthread") == std::string::npos)
    GTEST_SKIP() << "PoCL's two CPU devices are needed";
  const TemporaryFolder folder;
  const auto scene = folder.write("scene.json", everything_scene(36, 30));
  std::vector<Image> images;
  for (const char* devices : {"1", "1,0"}) {
    const auto picture = folder / (std::string(devices) + ".exr");
    const Outcome run = run_wale({"render", scene.string(), "-o", picture.string(), "--error", "0.12", "--quiet",
                                  "--device", devices, "--set", "integrator.pool=1024"},
                                 {two}, 300);
    ASSERT_EQ(run.status, 0) << run.err;
    images.push_back(read_image(picture));
  }
  EXPECT_EQ(different_pixels(images[0], images[1]), 0u);
}

TEST(Adaptive, TheActualErrorIsTheOneAskedFor) {
  const Studio studio(device(), everything(40));
  constexpr double kFine = 0.08;
  const Rendered r = studio.take(towards(kFine), 1);
  const Image a = studio.take(equal_samples(384), 1001).image, b = studio.take(equal_samples(384), 1002).image;
  const auto squared = actual_tile_errors(r.image, a, b, r.reached.floor);
  std::vector<double> sampled;
  for (size_t t = 0; t < squared.size(); ++t)
    if (r.image.at(int(t % 5) * 8, int(t / 5) * 8)[kSamplesChannel] > float(r.reached.least))
      sampled.push_back(squared[t]);
  ASSERT_GT(sampled.size(), 8u);
  EXPECT_LE(r.reached.worst, kFine);
  EXPECT_EQ(r.reached.missed, 0u);
  EXPECT_LT(summary(squared).worst, kFine * tolerance::kFactorOfGoal);
  EXPECT_LT(summary(sampled).rms, kFine * tolerance::kFactorOfGoal);
  EXPECT_GT(summary(sampled).rms, kFine / tolerance::kFactorOfGoal) << "more samples than were needed";
}

TEST(Adaptive, TheMeanOfManyPicturesIsTheTruth) {
  const Studio studio(device(), everything(24));
  constexpr int kPictures = 24;
  const Image truth = studio.take(equal_samples(1024), 999).image;
  const size_t values = truth.pixels.size(), stride = truth.channels.size();
  std::vector<double> sum(values), square(values), told(values);
  for (int seed = 0; seed < kPictures; ++seed) {
    const Rendered r = studio.take(towards(kGoal), unsigned(seed));
    EXPECT_GT(r.reached.most, r.reached.least);
    const Image& image = r.image;
    for (size_t i = 0; i < values; i += stride)
      for (size_t c = i; c < i + 3; ++c) {
        sum[c] += image.pixels[c];
        square[c] += double(image.pixels[c]) * image.pixels[c];
        told[c] += image.pixels[c + 3];
      }
  }
  double mean = 0, expected = 0, told_variance = 0, variance = 0;
  for (size_t i = 0; i < values; i += stride)
    for (size_t c = i; c < i + 3; ++c) {
      mean += sum[c] / kPictures;
      expected += truth.pixels[c];
      variance += (square[c] - sum[c] * sum[c] / kPictures) / (kPictures - 1);
      told_variance += told[c] / kPictures;
    }
  EXPECT_NEAR(mean / expected, 1, tolerance::kBiasShare);
  EXPECT_NEAR(told_variance / variance, 1, tolerance::kVarianceShare) << "of the variance channel";
}

// A small cloth before nothing: most tiles are empty.
TEST(Adaptive, SoonerThanEqualSamplesWhereMuchIsEmpty) {
  const std::string file = std::string(WALE_SOURCE_DIR) + "/scenes/check/sparse.json";
  const Studio studio(device(), read_scene(file, {"film.size=[64,64]"}));
  constexpr double kRough = 0.2;
  const Rendered adaptive = studio.take(towards(kRough), 1);
  EXPECT_LE(adaptive.reached.worst, kRough);
  const int half_again = int(std::ceil(1.5 * adaptive.reached.mean / 8)) * 8;
  EXPECT_GT(studio.take(equal_samples(half_again), 1).reached.worst, kRough)
      << "equal samples got there with " << half_again << " samples per pixel, " << adaptive.reached.mean
      << " were enough on average";
}

TEST(Adaptive, WhatCannotBeReachedStopsAtTheLimit) {
  const Studio studio(device(), everything(24));
  const Rendered r = studio.take(towards(1e-6, 20), 2);
  EXPECT_FALSE(r.stopped);
  EXPECT_EQ(r.reached.most, 20u);
  EXPECT_GT(r.reached.missed, 5u);
  EXPECT_GT(r.reached.worst, 1e-3);
  EXPECT_EQ(different_at(r.image, 20, studio.take(equal_samples(20), 2).image), 0u);
}

TEST(Adaptive, TheTimeLimitLeavesNoPixelOut) {
  const Studio studio(device(), everything(48));
  RenderOptions options = towards(0.01);
  options.pool = 256;
  options.seconds = 1e-6;
  const Rendered r = studio.take(options, 2);
  EXPECT_TRUE(r.stopped);
  EXPECT_EQ(r.reached.least, 1u);
  EXPECT_EQ(r.reached.most, 1u) << "nor does any get a second sample before all have one";
}

}  // namespace
}  // namespace wale::test
