// Statistics of windows, with known answers.
#include <gtest/gtest.h>

#include <numbers>
#include <numeric>

#include "host/fit/windows.h"
#include "tests/host/fit_pictures.h"

namespace wale::fit {
namespace {

double sum(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

TEST(FitWindows, CoverThePictureAndAreOfOneSize) {
  for (const int count : {1, 2, 3, 5}) {
    const auto all = windows(101, 60, count);
    ASSERT_EQ(all.size(), size_t(count * count));
    std::vector<int> covered(101 * 60);
    for (const Window& w : all) {
      EXPECT_EQ(w.width, all[0].width);
      EXPECT_EQ(w.height, all[0].height);
      EXPECT_NEAR(sum(w.across), 1, 1e-12);
      EXPECT_NEAR(sum(w.down), 1, 1e-12);
      ASSERT_TRUE(w.x >= 0 && w.y >= 0 && w.x + w.width <= 101 && w.y + w.height <= 60);
      for (int y = w.y; y < w.y + w.height; ++y)
        for (int x = w.x; x < w.x + w.width; ++x) covered[size_t(y * 101 + x)]++;
    }
    EXPECT_EQ(*std::min_element(covered.begin(), covered.end()), 1) << count;
    EXPECT_LE(*std::max_element(covered.begin(), covered.end()), 9) << count;
  }
}

TEST(FitWindows, FadeOutAsASquaredSine) {
  const Window window = windows(4, 9, 1)[0];
  const double s = std::sin(std::numbers::pi / 8), c = std::cos(std::numbers::pi / 8), sum_of_all = 2 * (s * s + c * c);
  EXPECT_NEAR(window.across[0], s * s / sum_of_all, 1e-12);
  EXPECT_NEAR(window.across[2], c * c / sum_of_all, 1e-12);
}

TEST(FitWindows, MomentsOfTwoColors) {
  const Picture halves = painted(8, 4, [](int x, int, int c) { return x < 4 ? 1 : c == 0 ? 3 : 2; });
  const ColorMoments moments = color_moments(halves, whole_picture(8, 4));
  EXPECT_NEAR(moments.mean[0], 2, 1e-12);
  EXPECT_NEAR(moments.mean[2], 1.5, 1e-12);
  EXPECT_NEAR(moments.covariance[0], 1, 1e-12);
  EXPECT_NEAR(moments.covariance[1], 0.5, 1e-12);
  EXPECT_NEAR(moments.covariance[5], 0.25, 1e-12);
  // Whatever the window: a flat picture has no variance.
  const ColorMoments flat =
      color_moments(painted(40, 40, [](int, int, int c) { return 1 + c; }), windows(40, 40, 3)[4]);
  EXPECT_NEAR(flat.mean[2], 3, 1e-12);
  for (const double value : flat.covariance) EXPECT_NEAR(value, 0, 1e-12);
}

// A grey wave has all its deviation, amplitude over the square root of 2, in the band of its frequency.
TEST(FitWindows, AWaveLiesInItsBand) {
  for (const auto& [periods, across] : {std::pair{8, true}, {8, false}, {20, true}, {3, false}}) {
    const double frequency = periods / 64.0;
    const Picture wave = painted(64, 64, [&](int x, int y, int) {
      return 0.5 + 0.2 * std::sin(2 * std::numbers::pi * frequency * (across ? x : y));
    });
    const auto bands = band_deviations(wave, whole_picture(64, 64));
    const size_t band = size_t(-2 * std::log2(frequency) - 1);
    ASSERT_LT(band, bands.size());
    for (size_t i = 0; i < bands.size(); ++i)
      EXPECT_NEAR(bands[i], i == band ? 0.2 / std::numbers::sqrt2 : 0, 1e-6) << periods << " band " << i;
    // A taper spreads it to the neighbours; the sum stays.
    double squares = 0;
    for (const double deviation : band_deviations(wave, windows(64, 64, 1)[0])) squares += deviation * deviation;
    EXPECT_NEAR(std::sqrt(squares), 0.2 / std::numbers::sqrt2, 0.003) << periods;
  }
}

TEST(FitWindows, BandsOfNoiseAddUpToItsVariance) {
  const Picture noise = random_picture(90, 62, 5);
  double squares = 0;
  for (const double deviation : band_deviations(noise, whole_picture(90, 62))) squares += deviation * deviation;
  const double weights = 0.2126 * 0.2126 + 0.7152 * 0.7152 + 0.0722 * 0.0722;
  EXPECT_NEAR(squares / (weights / 12), 1, 0.05);  // 5580 samples: two standard errors
}

}  // namespace
}  // namespace wale::fit
