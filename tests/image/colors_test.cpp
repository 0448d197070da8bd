// Colours of cloth in pictures: what is asked for is what is seen, and it lies where it belongs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "host/ply_colors.h"
#include "tests/image/picture.h"
#include "tests/temporary_folder.h"

namespace wale::test {
namespace {

constexpr Rgb kWhite{1, 1, 1};

Scene swatch(int pixels, int plies = 3) {
  Scene scene = empty_scene(0.008, pixels);
  add_fabric(scene, stockinette_pattern(), 0.016, 0.016, plies, "wool", kWhite);
  scene.lights.push_back(constant_environment(1));
  return scene;
}

/// Layers of stockinette, one on the other, too thick to look through in dark colours.
Scene thick(const std::string& preset, const Rgb& color) {
  Scene scene = empty_scene(0.006, 12);
  for (int i = 0; i < 5; ++i) {
    add_fabric(scene, stockinette_pattern(), 0.03, 0.03, 3, preset, color);
    scene.fabrics.back().transform.translate = {0.00037 * i, 0.00061 * i, -0.0013 * i};
  }
  scene.lights.push_back(constant_environment(1));
  return scene;
}

// Bounds are those of docs/appearance.md: the law is for a uniform medium.
TEST(Colors, ThickClothShowsTheColourAskedFor) {
  for (const char* preset : {"cotton", "wool"}) {
    const Rgb wanted{0.05, 0.2, 0.5};
    const std::array<double, 3> seen = mean_rgb(take(thick(preset, wanted), 192, 3).image);
    EXPECT_NEAR(seen[0], wanted[0], 0.01) << preset;
    EXPECT_NEAR(seen[1], wanted[1], 0.03) << preset;
    EXPECT_NEAR(seen[2], wanted[2], 0.05) << preset;
  }
}

TEST(Colors, TranslucentClothLetsMoreLightThrough) {
  double before = 0;
  for (const double translucency : {0.0, 0.5, 1.0}) {
    Scene scene = swatch(16);
    scene.materials[0].yarn.color = Rgb{0.6, 0.6, 0.6};
    scene.materials[0].yarn.translucency = translucency;
    scene.lights.clear();
    LightScene lamp;  // behind the cloth, as large as it seems from anywhere on it
    lamp.position = {0, 0, -0.05};
    lamp.look_at = {0, 0, 0};
    lamp.width = lamp.height = 0.1;
    scene.lights.push_back(lamp);
    // Plies alone: the gaps between them show the lamp, whatever the yarn.
    scene.camera.position = {0.16, 0, 0.05};
    scene.camera.look_at = {0, 0, 0};
    const Image image = take(scene, 256, 5).image;
    const double through = mean_rgb(image)[0];
    EXPECT_GT(through, before * 1.02) << translucency;
    before = through;
  }
}

// Every variation at once on white cloth: nothing is lost and nothing is won.
TEST(Colors, WhiteStaysWhiteWithEveryVariation) {
  TemporaryFolder folder;
  folder.write("white.ppm", "P3\n2 2\n255\n255 255 255 255 255 255\n255 255 255 255 255 255\n");
  for (const bool striped : {false, true}) {
    Scene scene = swatch(24);
    PlyAppearance& yarn = scene.materials[0].yarn;
    yarn.color.reset();
    if (striped)
      yarn.stripes = {{kWhite, 0.003}, {kWhite, 0.005}};
    else
      yarn.plies = {kWhite, kWhite};
    yarn.heather_yarn = yarn.heather_ply = 1;
    if (striped) {
      scene.fabrics[0].color_image.file = folder / "white.ppm";
      scene.fabrics[0].color_image.size = {0.004, 0.004};
    }
    const Picture picture = take(scene, 256, 1);
    size_t tests = 0;
    const double p = smallest_p(picture.image, 1.0, tests);
    EXPECT_GT(p, sidak(0.01, tests)) << striped;
    for (const double mean : mean_rgb(picture.image)) EXPECT_NEAR(mean, 1.0, 0.002) << striped;
  }
}

TEST(Colors, MarledClothLiesBetweenItsParts) {
  const Rgb dark{0.05, 0.1, 0.3}, light{0.8, 0.6, 0.4};
  const auto seen = [&](const std::vector<Rgb>& plies) {
    Scene scene = swatch(16, 2);
    scene.materials[0].yarn.color.reset();
    scene.materials[0].yarn.plies = plies;
    return mean_rgb(take(scene, 128, 2).image);
  };
  const auto a = seen({dark, dark}), b = seen({light, light}), both = seen({dark, light});
  for (size_t k = 0; k < 3; ++k) {
    EXPECT_GT(both[k], a[k] + 0.2 * (b[k] - a[k])) << k;
    EXPECT_LT(both[k], b[k] - 0.2 * (b[k] - a[k])) << k;
  }
}

TEST(Colors, OneColourInAllPliesIsTheMaterialsColour) {
  Scene plain = swatch(16), colored = swatch(16);
  const Rgb color{0.1, 0.4, 0.85};
  plain.materials[0].yarn.color = color;
  colored.materials[0].yarn.color.reset();
  colored.materials[0].yarn.plies = {color};
  const auto a = mean_rgb(take(plain, 64, 7).image), b = mean_rgb(take(colored, 64, 7).image);
  for (size_t k = 0; k < 3; ++k) EXPECT_NEAR(b[k], a[k], 0.004);  // ten bits
}

TEST(Colors, HeatherKeepsTheMeanOfTheCloth) {
  Scene plain = swatch(16), heathered = swatch(16);
  for (Scene* scene : {&plain, &heathered}) scene->materials[0].yarn.color = Rgb{0.3, 0.3, 0.3};
  heathered.materials[0].yarn.heather_ply = 0.4;
  const double a = mean_rgb(take(plain, 128, 3).image)[0], b = mean_rgb(take(heathered, 128, 3).image)[0];
  EXPECT_NEAR(b, a, 0.05 * a);
}

// A test picture over the stitches: white stitches on a dark ground, in the corner of a square, so that neither a flip
// nor a turn nor a shift by one stitch passes.
TEST(Colors, StitchesTakeTheirPixels) {
  const Pattern tile = stockinette_pattern();
  const double w = tile.period.x, h = tile.period.y;
  TemporaryFolder folder;
  // 4 x 3 stitches: an L with one dot, from the top.
  const std::string rows[3] = {"X..X", "X...", "XX.."};
  std::string text = "P3\n4 3\n255\n";
  for (const std::string& row : rows)
    for (const char c : row) text += c == 'X' ? "255 255 255 " : "0 0 0 ";
  folder.write("l.ppm", text);
  Scene scene = empty_scene(4 * w, 64);
  add_fabric(scene, tile, 8 * w, 8 * h, 3, "wool", Rgb{0, 0, 0});
  scene.fabrics[0].color_image.file = folder / "l.ppm";
  scene.fabrics[0].color_image.per_stitch = true;
  scene.fabrics[0].color_image.origin = {3, 3};
  scene.lights.push_back(constant_environment(1));
  scene.camera.position = {0, 0, 0.05};
  const Image image = take(scene, 32, 1, 0, true).image;
  // The legs of the V, about the stitch's middle. The bundled tile has the middle of its loop at its corner, and the
  // swatch of 8 x 8 stitches is centred: stitch (c, r) has its middle (c - 4, r - 4) stitches from the picture's.
  const auto brightness = [&](int column, int row) {
    double sum = 0;
    int count = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const double px = (x + 0.5) / image.width * 4 - 2 + 4;                 // in stitches from the left
        const double py = ((0.5 - (y + 0.5) / image.height) * 4 * w) / h + 4;  // and from below
        if (std::abs(px - column) < 0.35 && std::abs(py - row) < 0.3) {
          sum += image.at(x, y)[1];
          ++count;
        }
      }
    EXPECT_GT(count, 10);
    return sum / count;
  };
  double darkest_white = 1, brightest_dark = 0;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 4; ++c) {
      const double seen = brightness(3 + c, 3 + r);
      if (rows[2 - r][size_t(c)] == 'X')
        darkest_white = std::min(darkest_white, seen);
      else
        brightest_dark = std::max(brightest_dark, seen);
    }
  EXPECT_GT(darkest_white, 1.3 * brightest_dark);
}

}  // namespace
}  // namespace wale::test
