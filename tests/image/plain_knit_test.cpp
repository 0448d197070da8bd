// A picture that others made of closed-form stockinette against ours: K. Crane's plain-knit-yarn tile (height map and
// alpha, straight from above) is drawn from gamma(t) = (t + a sin 2t, h cos t, d cos 2t) with four plies about it. Tile
// reading, stitching, splines, joints and the orthographic camera all take part.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <numbers>

#include "tests/image/picture.h"

namespace wale::test {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi, kRow = 4.5, kUnit = 1e-3;
// a, h, d as published; plies, their helix and thickness were found by matching the picture.
constexpr double kRound = 1.5, kHeight = 4, kDepth = 1, kHelix = 0.5, kTube = 0.3536, kTwist = -5, kLag = 1;
constexpr int kPlies = 4;

/// Axis of one ply: the curve's Frenet frame, turned by twist t - 2 lag cos t. The back of the knit is ours: z is
/// turned.
dvec3 ply_axis(double t, int ply) {
  const dvec3 g(t + kRound * std::sin(2 * t), kHeight * std::cos(t), kDepth * std::cos(2 * t));
  const dvec3 g1(1 + 2 * kRound * std::cos(2 * t), -kHeight * std::sin(t), -2 * kDepth * std::sin(2 * t));
  const dvec3 g2(-4 * kRound * std::sin(2 * t), -kHeight * std::cos(t), -4 * kDepth * std::cos(2 * t));
  const dvec3 binormal = glm::normalize(glm::cross(g1, g2)), normal = glm::cross(binormal, glm::normalize(g1));
  const double angle = kTwist * t - 2 * kLag * std::cos(t) + kTwoPi * ply / kPlies;
  const dvec3 p = g + kHelix * (std::cos(angle) * normal + std::sin(angle) * binormal);
  return kUnit * dvec3(p.x, p.y, -p.z);
}

Pattern tile() {
  constexpr int kPoints = 240;
  Pattern p;
  p.name = "plain-knit";
  p.period = kUnit * dvec2(kTwoPi, kRow);
  p.yarn_radius = kUnit * kTube;
  p.stitches = ivec2(1, 1);
  for (int ply = 0; ply < kPlies; ++ply) {
    PatternCurve curve;
    for (int i = 0; i <= kPoints; ++i) curve.points.push_back(ply_axis(kTwoPi * i / kPoints, ply));
    p.curves.push_back(curve);
  }
  return p;
}

TEST(PlainKnit, HeightAndAlphaAgreeWithThePublishedTile) {
  const char* data = std::getenv("WALE_REAL_DATA");
  if (!data) GTEST_SKIP() << "real data not present";
  const std::filesystem::path folder = std::filesystem::path(data) / "yarn-patterns" / "plain-knit-yarn";
  const Image height = read_image(folder / "YarnTile-1528x1094-displacement.exr");
  const Image alpha = read_image(folder / "YarnTile-1528x1094-alpha.exr");

  constexpr int kWidth = 382, kDown = 274;
  Scene scene = empty_scene(kUnit * kRow, kDown);
  scene.film.width = kWidth;
  add_fabric(scene, tile(), kUnit * 6 * kTwoPi, kUnit * 8 * kRow, 1, "wool", std::nullopt);
  scene.fabrics.back().spec.tolerance = 0.01;
  scene.integrator.max_depth = 1;
  scene.lights.push_back(constant_environment(1));
  const Picture picture = take(scene, 8, 1, 0, true);
  const auto channel = [&](const char* name) {
    return size_t(std::find(picture.image.channels.begin(), picture.image.channels.end(), name) -
                  picture.image.channels.begin());
  };
  const size_t z = channel("position.Z"), coverage = channel("coverage");

  // The tile repeats, so only the place of its corner is unknown: found to a pixel by correlation.
  const auto ours = [&](int x, int y, size_t c) {
    return double(picture.image.at(((x % kWidth) + kWidth) % kWidth, ((y % kDown) + kDown) % kDown)[c]);
  };
  const auto theirs = [](const Image& image, int x, int y) {
    return double(image.at(std::min(image.width - 1, (2 * x + 1) * image.width / (2 * kWidth)),
                           std::min(image.height - 1, (2 * y + 1) * image.height / (2 * kDown)))[0]);
  };
  struct Fit {
    double correlation = -1, slope = 0, offset = 0;
    int dx = 0, dy = 0;
  };
  const auto fit_at = [&](int dx, int dy, int step) {
    double n = 0, sx = 0, sy = 0, sxx = 0, syy = 0, sxy = 0;
    for (int y = 0; y < kDown; y += step)
      for (int x = 0; x < kWidth; x += step) {
        if (theirs(alpha, x, y) < 1 || ours(x + dx, y + dy, coverage) < 1) continue;
        const double a = ours(x + dx, y + dy, z), b = theirs(height, x, y);
        n += 1, sx += a, sy += b, sxx += a * a, syy += b * b, sxy += a * b;
      }
    const double vx = sxx - sx * sx / n, vy = syy - sy * sy / n, c = sxy - sx * sy / n;
    return Fit{c / std::sqrt(vx * vy), c / vx, (sy - c / vx * sx) / n, dx, dy};
  };
  Fit best;
  for (int dy = 0; dy < kDown; dy += 4)
    for (int dx = 0; dx < kWidth; dx += 4)
      if (const Fit f = fit_at(dx, dy, 8); f.correlation > best.correlation) best = f;
  const Fit coarse = best;
  for (int dy = -5; dy <= 5; ++dy)
    for (int dx = -5; dx <= 5; ++dx)
      if (const Fit f = fit_at(coarse.dx + dx, coarse.dy + dy, 2); f.correlation > best.correlation) best = f;
  best = fit_at(best.dx, best.dy, 1);

  // Heights in tube radii, but for silhouettes, where half a pixel decides which ply is seen.
  std::vector<double> difference;
  size_t alpha_wrong = 0, both = 0;
  for (int y = 0; y < kDown; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const double covered = ours(x + best.dx, y + best.dy, coverage);
      const bool theirs_covered = theirs(alpha, x, y) > 0.5;
      alpha_wrong += (covered > 0.5) != theirs_covered;
      if (covered < 1 || !theirs_covered) continue;
      ++both;
      double step = 0;  // to the neighbours, in either picture
      for (const auto& [nx, ny] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
        if (ours(x + best.dx + nx, y + best.dy + ny, coverage) < 1) step = 1;
        step =
            std::max(step, std::abs(ours(x + best.dx + nx, y + best.dy + ny, z) - ours(x + best.dx, y + best.dy, z)));
        const int tx = std::clamp(x + nx, 0, kWidth - 1), ty = std::clamp(y + ny, 0, kDown - 1);
        step = std::max(step, std::abs(theirs(height, tx, ty) - theirs(height, x, y)) / best.slope);
      }
      if (step > 0.25 * kUnit * kTube) continue;
      difference.push_back(
          std::abs((theirs(height, x, y) - best.offset) / best.slope - ours(x + best.dx, y + best.dy, z)) /
          (kUnit * kTube));
    }
  std::sort(difference.begin(), difference.end());
  const auto quantile = [&](double q) { return difference[size_t(q * double(difference.size() - 1))]; };
  const double wrong = double(alpha_wrong) / (kWidth * kDown);
  std::printf(
      "correlation %.5f, difference in tube radii: median %.4f, 95 %% %.4f, worst %.3f; alpha differs in %.3f %%\n",
      best.correlation, quantile(0.5), quantile(0.95), quantile(1), 100 * wrong);
  EXPECT_GT(best.correlation, 0.99);
  EXPECT_GT(double(difference.size()), 0.6 * double(both));
  EXPECT_LT(quantile(0.95), 0.15);
  EXPECT_LT(wrong, 0.01);
  EXPECT_GT(best.slope, 0) << "the face looks at us";
}

}  // namespace
}  // namespace wale::test
