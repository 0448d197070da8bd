// Accuracy options as pictures: those that promise the same mean keep it, the others change what they say.
#include <gtest/gtest.h>

#include "tests/image/picture.h"

namespace wale::test {
namespace {

// Three lamps of unlike power around a cloth that lets light through: far, behind it, and a weak one near it, which
// lights it as much as the first and is chosen last.
Scene lamps(double pitch = 0.002) {
  Scene scene = empty_scene(0.01, 20);
  add_fabric(scene, straight_yarn(pitch, 0.0009), 0.012, 0.012, 2, "cotton", Rgb{0.8, 0.7, 0.6});
  LightScene far;
  far.kind = LightScene::Kind::sphere;
  far.position = {0.1, 0.1, 0.2};
  far.radius = 0.05;
  far.radiance = {30, 30, 30};
  LightScene behind = far;
  behind.position = {0, 0, -0.01};
  behind.radius = 0.004;
  behind.radiance = {4, 3, 2};
  LightScene near = far;
  near.position = {0.004, -0.003, 0.015};
  near.radius = 0.002;
  near.radiance = {80, 80, 80};
  scene.lights = {far, behind, constant_environment(0.2), near};
  return scene;
}

void expect_same_mean(const Picture& a, const Picture& b) {
  size_t tests = 0;
  const double p = smallest_p(a.image, b.image, tests);
  EXPECT_GT(p, sidak(1e-4, tests));
  EXPECT_GT(smallest_p_of_means(a.image, b.image), 1e-5);
  EXPECT_EQ(bad_events(b.counts), 0u);
}

TEST(Accuracy, ChoiceOfLightsKeepsTheMean) {
  Scene scene = lamps();
  scene.integrator.light_sampling = "light";  // MIS would hide most of a wrong probability
  const Picture power = take(scene, 128, 1);
  scene.integrator.light_choice = "uniform";
  const Picture uniform = take(scene, 128, 2);
  expect_same_mean(power, uniform);
  EXPECT_NE(mean_rgb(power.image), mean_rgb(uniform.image));
}

// Behind the cloth stands a lamp: plies that stop its light whole make the front darker, and not where nothing does.
TEST(Accuracy, OpaquePlyShadowsDarkenWhatIsLitThroughPlies) {
  Scene scene = lamps(0.0008);  // no gaps
  scene.lights = {scene.lights[1]};
  scene.materials[0].yarn.optical_radius = 0.3;  // a thin ply
  scene.integrator.light_sampling = "light";
  const auto attenuated = mean_rgb(take(scene, 64, 1).image);
  scene.integrator.ply_shadows = "opaque";
  const auto opaque = mean_rgb(take(scene, 64, 1).image);
  for (int k = 0; k < 3; ++k) EXPECT_LT(opaque[size_t(k)], 0.98 * attenuated[size_t(k)]);
  scene.materials[0].yarn.optical_radius = 1000;  // nothing passes through plies anyhow
  const auto solid = mean_rgb(take(scene, 16, 1).image);
  scene.integrator.ply_shadows = "attenuated";
  const auto same = mean_rgb(take(scene, 16, 1).image);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(solid[size_t(k)], same[size_t(k)], 2e-3 * same[size_t(k)]);
}

// Relaxed arithmetic may flip single decisions, not the picture.
TEST(Accuracy, RelaxedArithmeticKeepsTheMean) {
  Scene scene = lamps();
  const Picture exact = take(scene, 64, 1);
  scene.integrator.math = "relaxed";
  const Picture relaxed = take(scene, 64, 2);
  expect_same_mean(exact, relaxed);
}

}  // namespace
}  // namespace wale::test
