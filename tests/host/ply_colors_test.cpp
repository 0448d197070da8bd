// Colours that vary, as they are baked.
#include "host/ply_colors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "geom/base_mesh_generators.h"
#include "geom/error.h"
#include "host/materials.h"
#include "host/thick_layer.h"

namespace wale {
namespace {

Fabric knit(int plies, bool places) {
  FabricSpec spec;
  spec.name = "cloth";
  spec.scale.kind = FabricScale::Kind::uv_metres;
  spec.plies = plies;
  spec.places = places;
  return knit_fabric(make_swatch(0.02, 0.02, 4, 4), stockinette_pattern(), spec);
}

Image two_by_two() {
  Image image;
  image.width = image.height = 2;
  image.channels = {"R", "G", "B"};
  image.pixels = {1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1};  // red, green above blue, white
  return image;
}

TEST(PlyColors, PackingKeepsTheEndsAndRounds) {
  for (int i = 0; i <= 10000; ++i) {
    const double c = i / 10000.0;
    const uint32_t word = pack_ply_color({c, 1, 0});
    EXPECT_TRUE(word & W_COLOR_GIVEN);
    const Rgb back = unpack_ply_color(word);
    EXPECT_NEAR(back[0], c, 1.0 / 1023);
    EXPECT_NEAR(1 - back[0], 1 - c, std::sqrt(1 - c) / 1023 + 1e-6) << "relative to what is absorbed";
    EXPECT_EQ(back[1], 1);
    EXPECT_EQ(back[2], 0);
  }
}

TEST(PlyColors, HeatherKeepsTheMeanAndTheWhite) {
  for (const double spread : {0.1, 0.5, 1.0})
    for (const Rgb& color : {Rgb{0.2, 0.1, 0.05}, Rgb{0.9, 0.5, 0.2}, Rgb{1, 1, 1}, Rgb{0, 0, 0}}) {
      Rgb mean{0, 0, 0};
      constexpr int kSteps = 1000;
      for (int i = 0; i < kSteps; ++i) {
        const Rgb c = heathered(color, 2 * (i + 0.5) / kSteps - 1, spread);
        for (int k = 0; k < 3; ++k) {
          EXPECT_GE(c[k], 0);
          EXPECT_LE(c[k], 1);
          mean[k] += c[k] / kSteps;
        }
        if (color[0] == 1) {
          EXPECT_EQ(c, color);
        }
      }
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(mean[k], color[k], 1e-9);
    }
}

TEST(PlyColors, PliesTakeTurns) {
  PlyAppearance yarn;
  yarn.plies = {{1, 0, 0}, {0, 0, 1}};
  const Fabric fabric = knit(3, false);
  const auto words = bake_ply_colors(fabric, yarn, {}, {});
  ASSERT_EQ(words.size(), fabric.anchors.size());
  for (const PlyRun& run : fabric.runs)
    for (uint32_t k = 0; k < 3 * run.count; ++k)
      EXPECT_EQ(words[run.first_vertex + k], pack_ply_color((k / run.count) % 2 == 0 ? Rgb{1, 0, 0} : Rgb{0, 0, 1}));
}

TEST(PlyColors, YarnsOfTheTileTakeThePalette) {
  Fabric fabric = knit(2, false);
  ASSERT_GT(fabric.runs.size(), 2u);
  for (size_t r = 0; r < fabric.runs.size(); ++r) fabric.runs[r].color = uint32_t(r % 2);
  PlyAppearance yarn;
  const std::vector<Rgb> yarns = {{1, 0, 0}, {0, 0, 1}};
  const auto words = bake_ply_colors(fabric, yarn, {}, {}, yarns);
  for (const PlyRun& run : fabric.runs)
    for (uint32_t k = 0; k < 2 * run.count; ++k)
      EXPECT_EQ(words[run.first_vertex + k], pack_ply_color(yarns[run.color]));
  yarn.plies = {{0, 1, 0}};
  EXPECT_EQ(bake_ply_colors(fabric, yarn, {}, {}, yarns)[0], pack_ply_color({0, 1, 0}))
      << "the material's plies go first";
}

TEST(PlyColors, ScenesReplaceThePaletteOfTheTile) {
  Pattern tile;
  tile.palette = {{0, 0, 0}, {255, 255, 255}};
  FabricScene fabric;
  EXPECT_EQ(yarn_colors(fabric, tile), (std::vector<Rgb>{{0, 0, 0}, {1, 1, 1}}));
  fabric.palette = {{0.5, 0.25, 0}};
  EXPECT_EQ(yarn_colors(fabric, tile), (std::vector<Rgb>{{0.5, 0.25, 0}}));
  fabric.palette = std::vector<Rgb>{};
  EXPECT_TRUE(yarn_colors(fabric, tile).empty());
}

// Each run takes the colour of the tile's yarn that it came from.
TEST(PlyColors, RunsKnowTheirYarnInTheTile) {
  Pattern tile = stockinette_pattern();
  PatternCurve second = tile.curves[0];
  second.yarn = 1;
  for (dvec3& p : second.points) p.y += tile.period.y;
  tile.period.y *= 2;
  tile.curves.push_back(second);
  FabricSpec spec;
  spec.scale.repeats = {500, 430};  // a metre; the UVs are metres
  const Fabric fabric = knit_fabric(make_swatch(0.012, 0.007, 4, 4), tile, spec);
  size_t count[2] = {0, 0};
  for (const PlyRun& run : fabric.runs) {
    ASSERT_LT(run.color, 2u);
    ++count[run.color];
  }
  EXPECT_GE(count[0], 3u);
  EXPECT_GE(count[1], 3u);
}

TEST(PlyColors, StripesShareTheStrandByTheirLengths) {
  PlyAppearance yarn;
  yarn.stripes = {{{1, 1, 1}, 0.010}, {{0, 0, 0}, 0.030}};
  const Fabric fabric = knit(2, true);
  const auto words = bake_ply_colors(fabric, yarn, {}, {});
  double white = 0, all = 0;
  for (const PlyRun& run : fabric.runs)
    for (uint32_t k = 0; k + 1 < run.count; ++k) {
      const StrandPlace &a = fabric.place[run.first_vertex / 2 + k], &b = fabric.place[run.first_vertex / 2 + k + 1];
      const bool is_white = words[run.first_vertex + k] == pack_ply_color({1, 1, 1});
      EXPECT_EQ(is_white, std::fmod(a.along, 0.040) < 0.010);
      EXPECT_EQ(words[run.first_vertex + run.count + k], words[run.first_vertex + k]) << "all plies alike";
      white += is_white * std::abs(b.along - a.along);
      all += std::abs(b.along - a.along);
    }
  EXPECT_GT(all, 1);  // more than a metre of yarn
  EXPECT_NEAR(white / all, 0.25, 0.01);
}

TEST(PlyColors, ImagesColourStitches) {
  PlyAppearance yarn;
  yarn.color = Rgb{0.5, 0.5, 0.5};
  const Fabric fabric = knit(1, true);
  ColorImage image;
  image.file = "four.png";
  image.per_stitch = true;
  image.repeat = true;
  const Image pixels = two_by_two();
  const auto words = bake_ply_colors(fabric, yarn, image, pixels);
  std::set<uint32_t> seen(words.begin(), words.end());
  EXPECT_EQ(seen.size(), 4u);
  for (size_t i = 0; i < words.size(); ++i) {
    const ivec2 s = fabric.place[i].stitch;
    const bool right = s.x & 1, up = s.y & 1;
    const Rgb expected = up ? (right ? Rgb{0, 1, 0} : Rgb{1, 0, 0}) : right ? Rgb{1, 1, 1} : Rgb{0, 0, 1};
    EXPECT_EQ(words[i], pack_ply_color(expected)) << s.x << " " << s.y;
  }
  // Over the UV, once: one quarter of the swatch in each colour, and beyond the image the material's own.
  image.per_stitch = image.repeat = false;
  image.size = {0.01, 0.02};
  const auto once = bake_ply_colors(fabric, yarn, image, pixels);
  size_t own = 0;
  for (size_t i = 0; i < once.size(); ++i) {
    const StrandPlace& p = fabric.place[i];
    if (p.u < 0 || p.v < 0 || p.u >= 0.01 || p.v >= 0.02) {
      EXPECT_EQ(once[i], 0u);
      ++own;
    } else {
      const Rgb c = unpack_ply_color(once[i]);
      EXPECT_EQ(c[0], (p.v >= 0.01) != (p.u >= 0.005) ? 1 : 0);
      EXPECT_EQ(c[1], p.u >= 0.005 ? 1 : 0);
    }
  }
  EXPECT_GT(own, once.size() / 3);
  EXPECT_LT(own, once.size() * 2 / 3);
}

TEST(PlyColors, ColoursBecomeFibresOrTints) {
  PlyAppearance yarn;
  yarn.plies = {{0.3, 0.6, 0.9}};
  const Fabric fabric = knit(1, false);
  const ThickLayer layer(ply_material(yarn));
  EXPECT_EQ(bake_ply_colors(fabric, yarn, {}, {})[0], pack_ply_color(layer.fibre(Rgb{0.3, 0.6, 0.9})));
  yarn.forward = yarn.back = Rgb{0.5, 0.5, 0.5};
  EXPECT_EQ(bake_ply_colors(fabric, yarn, {}, {})[0], pack_ply_color({0.3, 0.6, 0.9}));
}

TEST(PlyColors, HeatherVariesByYarnAndByPly) {
  PlyAppearance yarn;
  yarn.color = Rgb{0.4, 0.4, 0.4};
  yarn.heather_yarn = 0.5;
  const Fabric fabric = knit(2, false);
  const auto by_yarn = bake_ply_colors(fabric, yarn, {}, {});
  yarn.heather_yarn = 0;
  yarn.heather_ply = 0.5;
  const auto by_ply = bake_ply_colors(fabric, yarn, {}, {});
  std::set<uint32_t> yarns, plies, full;
  size_t different = 0;
  for (const PlyRun& run : fabric.runs) {
    full.insert(run.yarn);
    yarns.insert(by_yarn[run.first_vertex]);
    EXPECT_EQ(by_yarn[run.first_vertex], by_yarn[run.first_vertex + run.count]);
    different += by_ply[run.first_vertex] != by_ply[run.first_vertex + run.count];
    plies.insert(by_ply[run.first_vertex]);
    plies.insert(by_ply[run.first_vertex + run.count]);
  }
  EXPECT_GT(yarns.size(), full.size() * 2 / 3);
  EXPECT_GT(plies.size(), full.size());
  EXPECT_GT(different, fabric.runs.size() * 2 / 3);
}

TEST(PlyColors, PixelsOutsideTheRangeAreRefused) {
  ColorImage image;
  image.file = "bright.exr";
  Image pixels = two_by_two();
  pixels.pixels[3] = 1.5f;
  try {
    bake_ply_colors(knit(1, true), {}, image, pixels);
    FAIL() << "accepted a pixel of 1.5";
  } catch (const Error& e) {
    EXPECT_EQ(e.fault(), Fault::user);
    EXPECT_STREQ(e.what(), "bright.exr: pixel (1, 0) has a colour of 1.5; colours of cloth are 0 to 1");
  }
}

}  // namespace
}  // namespace wale
