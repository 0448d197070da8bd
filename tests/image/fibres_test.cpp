// Pictures of explicit fibres and flyaways: the white furnace, determinism, and nothing of it where there is none.
#include <gtest/gtest.h>

#include <algorithm>

#include "host/features.h"
#include "host/stages.h"
#include "tests/image/picture.h"

namespace wale::test {
namespace {

Scene one_ply_of_twenty(int pixels) {
  Scene scene = empty_scene(0.002, pixels);
  add_fabric(scene, straight_yarn(0.002, 0.0005), 0.006, 0.002, 1, "wool", Rgb{1, 1, 1});
  scene.materials[0].yarn.fibres.count = 20;
  scene.fabrics[0].spec.detail = Detail::fibres;
  return scene;
}

Scene swatch(int pixels, Detail detail) {
  Scene scene = empty_scene(0.004, pixels);
  add_fabric(scene, stockinette_pattern(), 0.008, 0.008, 2, "cotton", Rgb{1, 1, 1});
  scene.materials[0].yarn.fibres.count = 12;
  scene.fabrics[0].spec.detail = detail;
  scene.fabrics[0].spec.flyaways.hairs = scene.fabrics[0].spec.flyaways.loops = 1000;
  return scene;
}

void expect_furnace(Scene scene, const char* light_sampling, int spp, double bound) {
  scene.lights.push_back(constant_environment(1));
  scene.integrator.light_sampling = light_sampling;
  const Picture picture = take(scene, spp, 1);
  size_t tests = 0;
  const double p = smallest_p(picture.image, 1.0, tests);
  EXPECT_GT(p, sidak(0.01, tests));
  for (const double mean : mean_rgb(picture.image)) EXPECT_NEAR(mean, 1.0, bound);
  EXPECT_EQ(bad_events(picture.counts), 0u);
  EXPECT_GT(picture.counts.bounce, picture.counts.primary / 4) << "the fibres were not hit";
}

TEST(FibreFurnace, OnePlyOfTwentyFibresByBothSamplings) { expect_furnace(one_ply_of_twenty(32), "mis", 128, 0.002); }
TEST(FibreFurnace, OnePlyOfTwentyFibresByBsdfSampling) { expect_furnace(one_ply_of_twenty(32), "bsdf", 64, 0.002); }
TEST(FibreFurnace, SwatchOfFibresWithFlyaways) { expect_furnace(swatch(24, Detail::fibres), "mis", 64, 0.004); }
TEST(FibreFurnace, SwatchOfPliesWithFlyaways) { expect_furnace(swatch(24, Detail::maps), "mis", 64, 0.004); }

TEST(FibreDeterminism, EveryPoolGivesTheSameBytes) {
  for (const Detail detail : {Detail::fibres, Detail::maps}) {
    Scene scene = swatch(30, detail);
    scene.lights.push_back(constant_environment(1));
    scene.materials[0].yarn.color = Rgb{0.9, 0.6, 0.4};
    const Picture expected = take(scene, 9, 3, 65536, true);
    for (const uint32_t pool : {1000u, 257u}) {
      const Picture picture = take(scene, 9, 3, pool, true);
      size_t different = 0;
      for (int y = 0; y < picture.image.height; ++y)
        for (int x = 0; x < picture.image.width; ++x)
          different += !std::equal(picture.image.at(x, y), picture.image.at(x, y) + picture.image.channels.size(),
                                   expected.image.at(x, y));
      EXPECT_EQ(different, 0u) << pool;
      EXPECT_EQ(picture.counts.shadow, expected.counts.shadow);
    }
  }
}

bool stage_used(const Features& features, const std::string& file) {
  for (const Stage& stage : wavefront_stages(features))
    if (stage.file == file) return stage.used;
  ADD_FAILURE() << file;
  return false;
}

DeviceTraits test_traits() {
  DeviceTraits traits;
  traits.lanes = 16;
  return traits;
}

TEST(FibreFeatures, AreThereOnlyForScenesThatHaveThem) {
  const Loaders loaders;
  const auto features_of = [&](const Scene& scene) {
    return analyse(build_world(scene, loaders), scene.integrator, false, test_traits());
  };
  Scene plain = swatch(8, Detail::maps);
  plain.fabrics[0].spec.flyaways = {};
  const Features without = features_of(plain), both = features_of(swatch(8, Detail::maps)),
                 fibres = features_of(swatch(8, Detail::fibres));
  EXPECT_EQ(without.options().find("W_HAS_FIBRES"), std::string::npos);
  EXPECT_FALSE(stage_used(without, "stages/shade_fibre.cl"));
  EXPECT_TRUE(stage_used(without, "stages/shade_ply.cl"));
  EXPECT_TRUE(stage_used(both, "stages/shade_fibre.cl"));
  EXPECT_TRUE(stage_used(both, "stages/shade_ply.cl"));
  EXPECT_TRUE(stage_used(fibres, "stages/shade_fibre.cl"));
  EXPECT_FALSE(stage_used(fibres, "stages/shade_ply.cl"));
  EXPECT_NE(fibres.options().find("W_HAS_PLIES"), std::string::npos);  // the traversal needs its curves
  EXPECT_TRUE(build_world(plain, loaders).fibre_materials.empty());
}

}  // namespace
}  // namespace wale::test
