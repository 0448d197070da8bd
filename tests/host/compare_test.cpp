// Figures of `wale compare` with known values.
#include "host/compare.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "host/flip.h"
#include "tests/temporary_folder.h"

namespace wale {
namespace {

Image flat(int width, int height, float r, float g, float b) {
  Image image{width, height, {"R", "G", "B"}, {}};
  for (int i = 0; i < width * height; ++i) image.pixels.insert(image.pixels.end(), {r, g, b});
  return image;
}

TEST(Compare, EqualImagesDifferByNothing) {
  const Image a = flat(20, 10, 0.2f, 0.5f, 0.7f);
  const CompareReport report = compare_images(a, a);
  EXPECT_EQ(report.rmse, 0);
  EXPECT_EQ(report.relative_mse, 0);
  EXPECT_EQ(report.flip_mean, 0);
  EXPECT_EQ(report.largest, 0);
  EXPECT_NEAR(report.mean_a[1], 0.5, 1e-7);
}

TEST(Compare, OnePixelOff) {
  const Image b = flat(8, 4, 0.5f, 0.5f, 0.5f);
  Image a = b;
  a.at(5, 2)[2] = 1.0f;
  const CompareReport report = compare_images(a, b, "a", "b", 0.25);
  EXPECT_NEAR(report.rmse, std::sqrt(0.25 / 96), 1e-12);
  EXPECT_NEAR(report.relative_mse, 0.25 / (0.25 + 0.25) / 96, 1e-12);
  EXPECT_NEAR(report.largest, 0.5, 1e-12);
  EXPECT_EQ(report.largest_x, 5);
  EXPECT_EQ(report.largest_y, 2);
  EXPECT_EQ(report.largest_channel, "B");
  EXPECT_NEAR(report.mean_a[2], 0.5 + 0.5 / 32, 1e-7);
  EXPECT_NE(report.text().find("pixel (5, 2), channel B"), std::string::npos) << report.text();
}

TEST(Compare, ChannelsAreFoundByName) {
  Image a{1, 1, {"depth.Z", "B", "G", "R"}, {9, 3, 2, 1}};
  EXPECT_EQ(compare_images(a, flat(1, 1, 1, 2, 3)).rmse, 0);
}

TEST(Compare, SizesMustAgree) {
  EXPECT_EQ(user_message([] { compare_images(flat(2, 3, 0, 0, 0), flat(3, 2, 0, 0, 0), "a.exr", "b.exr"); }),
            "a.exr is 2 x 3, b.exr is 3 x 2: images of one size are needed");
}

TEST(Compare, NanIsRefusedWithItsPixel) {
  Image a = flat(2, 2, 0, 0, 0);
  a.at(1, 0)[0] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(user_message([&] { compare_images(flat(2, 2, 0, 0, 0), a, "a", "b"); }),
            "b: pixel (1, 0): nan is not a finite number");
}

double flip_mean(const Image& a, const Image& b) { return compare_images(a, b).flip_mean; }

TEST(Flip, GreenAgainstBlueIsTheLargestColourDifference) {
  // The normalisation of Andersson et al. 2020, 4.1.4: this pair defines 1.
  EXPECT_NEAR(flip_mean(flat(16, 16, 0, 1, 0), flat(16, 16, 0, 0, 1)), 1, 1e-4);
}

TEST(Flip, BlackAgainstWhite) {
  // Flat images: no features; HyAB = 100, cmax from green and blue after the Hunt adjustment. Worked by hand from
  // CIELab: green L 87.74 a -86.18 b 83.18, blue L 32.30 a 79.20 b -107.86; Hunt scales a, b by L/100: |dL| = 55.44,
  // chroma (-75.61-25.58, 72.98+34.84) -> hypot 147.87; cmax = 203.31^0.7.
  const double ratio = std::pow(100 / 203.31, 0.7);
  const double expected = 0.95 + (ratio - 0.4) / 0.6 * 0.05;
  EXPECT_NEAR(flip_mean(flat(16, 16, 0, 0, 0), flat(16, 16, 1, 1, 1)), expected, 1e-3);
}

TEST(Flip, AgreesWithThePublishedProgram) {
  // The authors' program (flip-evaluator on PyPI, LDR, default 67 pixels per degree) gives 0.239378 for these PNGs.
  Image a = flat(200, 150, 0, 0, 0), b = a;
  uint32_t state = 1;
  const auto uniform = [&] {
    state = state * 1664525u + 1013904223u;
    return float(state >> 8) / 16777216.0f;
  };
  for (int y = 0; y < 150; ++y)
    for (int x = 0; x < 200; ++x)
      for (int c = 0; c < 3; ++c) {
        const float wave = std::sin(0.05f * float(x * (c + 1))) * std::cos(0.07f * float(y));
        const float v = 0.5f + 0.4f * wave * ((x / 20 + y / 20) % 2 ? 1.0f : 0.5f);
        a.at(x, y)[c] = v;
        b.at(x, y)[c] = std::clamp(v + 0.2f * (uniform() - 0.5f) + (x > 100 ? 0.1f * float(c) : 0.0f), 0.0f, 1.0f);
      }
  TemporaryFolder folder;
  write_image(a, folder / "a.png", 0, "srgb");
  write_image(b, folder / "b.png", 0, "srgb");
  EXPECT_NEAR(flip_mean(read_image(folder / "a.png"), read_image(folder / "b.png")), 0.239378, 5e-5);
}

TEST(Flip, IsSymmetricAndGrowsWithTheDifference) {
  const Image a = flat(16, 16, 0.2f, 0.2f, 0.2f), b = flat(16, 16, 0.22f, 0.2f, 0.2f),
              c = flat(16, 16, 0.4f, 0.2f, 0.2f);
  EXPECT_NEAR(flip_mean(a, b), flip_mean(b, a), 1e-7);
  EXPECT_GT(flip_mean(a, b), 0);
  EXPECT_GT(flip_mean(a, c), 2 * flip_mean(a, b));
}

TEST(Flip, FinePatternsThatTheEyeBlursCountLessThanCoarseOnes) {
  Image gray = flat(64, 64, 0.5f, 0.5f, 0.5f), fine = gray, coarse = gray;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x)
      for (int c = 0; c < 3; ++c) {
        fine.at(x, y)[c] += (x + y) % 2 ? 0.05f : -0.05f;
        coarse.at(x, y)[c] += (x / 16 + y / 16) % 2 ? 0.05f : -0.05f;
      }
  EXPECT_LT(flip_mean(fine, gray), 0.5 * flip_mean(coarse, gray));
}

TEST(Flip, TheDifferenceIsWhereItIs) {
  std::vector<float> a(64 * 64 * 3, 0.2f), b = a;
  for (int y = 28; y < 36; ++y)
    for (int x = 8; x < 16; ++x) b[3 * (64 * y + x)] = 0.9f;
  const auto map = flip_map(a, b, 64, 64);
  EXPECT_GT(map[64 * 32 + 12], 0.3f);
  EXPECT_LT(map[64 * 32 + 50], 1e-3f);
  for (float v : map) ASSERT_TRUE(v >= 0 && v <= 1);
}

}  // namespace
}  // namespace wale
