// From afar the detail must neither change the brightness of the cloth nor crawl: an orthographic zoom over whole
// stitches and a slow pan.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "tests/image/picture.h"

namespace wale::test {
namespace {

bool long_tests() {
  const char* wanted = std::getenv("WALE_LONG_TESTS");
  return wanted && std::string(wanted) == "1";
}

constexpr int kAcross = 40, kDown = 24;

/// Stockinette whose course is exactly 0.6 of its wale, so that n x n stitches fill a film of 40 x 24 pixels.
Pattern even_stockinette() {
  Pattern pattern = stockinette_pattern();
  const double factor = 0.6 * pattern.period.x / pattern.period.y;
  for (auto& curve : pattern.curves)
    for (auto& point : curve.points) point.y *= factor;
  pattern.period.y *= factor;
  return pattern;
}

/// `stitches` x `stitches` of a slightly larger swatch in even light from afar, moved by `pan` stitches.
Scene cloth(int stitches, double pan) {
  const Pattern pattern = even_stockinette();
  Scene scene = empty_scene(stitches * pattern.period.y, kDown);
  // One stitch is looked at so closely that its fibres show; the samples are shared out.
  const int finer = stitches == 1 ? 4 : 1;
  scene.film.width = finer * kAcross;
  scene.film.height = finer * kDown;
  scene.camera.position.x = scene.camera.look_at.x = pan * pattern.period.x;
  add_fabric(scene, pattern, (stitches + 8) * pattern.period.x, (stitches + 8) * pattern.period.y, 3, "wool",
             Rgb{0.9, 0.7, 0.5});
  LightScene lamp;
  lamp.kind = LightScene::Kind::sphere;
  lamp.position = {-20, 20, 50};
  lamp.radius = 4;
  lamp.radiance = {60, 60, 60};
  scene.lights.push_back(lamp);
  scene.lights.push_back(constant_environment(0.3));
  return scene;
}

TEST(Zoom, BrightnessStaysOverWholeStitches) {
  const std::vector<int> views =
      long_tests() ? std::vector<int>{1, 2, 5, 10, 20, 50, 100, 200} : std::vector<int>{1, 24};
  const int spp = long_tests() ? 1024 : 256;
  std::array<double, 3> near{};
  for (const int stitches : views) {
    const auto mean = mean_rgb(take(cloth(stitches, 0), stitches == 1 ? spp / 16 : spp, 1).image);
    if (stitches == views[0]) near = mean;
    std::printf("%3d stitches: %.5f %.5f %.5f\n", stitches, mean[0], mean[1], mean[2]);
    for (size_t k = 0; k < 3; ++k) EXPECT_NEAR(mean[k] / near[k], 1, 0.01) << stitches << " stitches, channel " << k;
  }
}

// Every pixel of 200 stitches across holds five whole ones: a pan moves detail through it and must change nothing.
TEST(Zoom, PanChangesPixelsByNoMoreThanNoise) {
  const int stitches = long_tests() ? 200 : 40, spp = long_tests() ? 256 : 96;
  const Picture first = take(cloth(stitches, 0), spp, 1);
  unsigned seed = 2;
  for (const double pan : {0.13, 0.31, 0.5}) {
    size_t tests = 0;
    const double p = smallest_p(first.image, take(cloth(stitches, pan), spp, seed++).image, tests);
    EXPECT_GT(p, sidak(0.01 / 3, tests)) << "moved by " << pan << " stitches";
  }
}

}  // namespace
}  // namespace wale::test
