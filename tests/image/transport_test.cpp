// Light transport without fabric against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/image/picture.h"

namespace wale::test {
namespace {

using std::numbers::pi;

// A small patch of a large diffuse ground z = 0, seen from above.
Scene ground_scene(double patch, const Rgb& color) {
  Scene scene = empty_scene(patch, 16);
  MaterialSpec material;
  material.name = "ground";
  material.surface.color = color;
  scene.materials.push_back(material);
  ObjectScene ground;
  ground.kind = ObjectScene::Kind::ground;
  ground.up = dvec3(0, 0, 1);
  ground.extent = 100;
  scene.objects.push_back(ground);
  return scene;
}

void expect_mean(const Scene& scene, double expected, int spp = 512) {
  for (const char* mode : {"mis", "light"}) {
    Scene s = scene;
    s.integrator.light_sampling = mode;
    for (const double mean : mean_rgb(take(s, spp).image)) EXPECT_NEAR(mean / expected, 1.0, 0.005) << mode;
  }
}

TEST(Transport, GroundUnderASphereLight) {
  // Irradiance of a sphere of radius r and radiance L at distance d above a horizontal point: pi L (r/d)^2.
  Scene scene = ground_scene(1e-3, {0.6, 0.6, 0.6});
  LightScene light;
  light.kind = LightScene::Kind::sphere;
  light.position = dvec3(0, 0, 0.5);
  light.radius = 0.1;
  light.radiance = {3, 3, 3};
  scene.lights.push_back(light);
  // The camera looks from above the light along -z, and would see its back: look from the side of it.
  scene.camera.position = dvec3(0, 0, 0.2);
  expect_mean(scene, 0.6 * 3 * 0.04);
}

TEST(Transport, GroundUnderAQuadLight) {
  // Form factor of a rectangle a x b, parallel, its corner above the point at height h: sum of four such corners.
  const double w = 0.6, h = 0.5, a = w / 2 / h;
  const double s = std::sqrt(1 + a * a);
  const double corner = 2 * (a / s * std::atan(a / s)) / (2 * pi);
  Scene scene = ground_scene(1e-3, {0.5, 0.5, 0.5});
  LightScene light;
  light.kind = LightScene::Kind::quad;
  light.position = dvec3(0, 0, h);
  light.look_at = dvec3(0, 0, 0);
  light.up = dvec3(0, 1, 0);
  light.width = light.height = w;
  light.radiance = {2, 2, 2};
  scene.lights.push_back(light);
  scene.camera.position = dvec3(0, 0, 0.2);
  expect_mean(scene, 0.5 * 2 * 4 * corner);
}

TEST(Transport, GroundUnderAConstantSky) {
  Scene scene = ground_scene(1e-3, {0.7, 0.7, 0.7});
  scene.lights.push_back(constant_environment(1.5));
  expect_mean(scene, 0.7 * 1.5);
}

// The last scattering event of a limited path is lit the same, whichever way its light is found.
TEST(Transport, TheLengthLimitTakesNoDirectLight) {
  Scene scene = ground_scene(1e-3, {0.7, 0.7, 0.7});
  scene.lights.push_back(constant_environment(1.5));
  scene.integrator.max_depth = 1;
  for (const char* mode : {"mis", "light", "bsdf"}) {
    scene.integrator.light_sampling = mode;
    for (const double mean : mean_rgb(take(scene, 256).image)) EXPECT_NEAR(mean, 0.7 * 1.5, 0.005) << mode;
  }

  Scene cloth = empty_scene(0.002, 16);
  add_fabric(cloth, straight_yarn(0.002, 0.0007), 0.006, 0.002, 3, "cotton", Rgb{1, 1, 1});
  cloth.lights.push_back(constant_environment(1));
  for (const int depth : {1, 2}) {
    cloth.integrator.max_depth = depth;
    cloth.integrator.light_sampling = "bsdf";
    const double expected = mean_rgb(take(cloth, 256).image)[0];
    EXPECT_LT(expected, 0.97) << "the limit does nothing here";
    for (const char* mode : {"mis", "light"}) {
      cloth.integrator.light_sampling = mode;
      EXPECT_NEAR(mean_rgb(take(cloth, 512).image)[0] / expected, 1, 0.01) << mode << " " << depth;
    }
  }
}

TEST(Transport, RaysOfPaddedPixelsAreNotCounted) {
  Scene scene = ground_scene(1e-3, {0.7, 0.7, 0.7});
  scene.film.width = 7;
  scene.film.height = 5;
  EXPECT_EQ(take(scene, 3).counts.primary, 7u * 5u * 3u);
}

// A ball as large as a floor: what lies closer to it than a share of its radius is not lost.
TEST(Transport, HugeSphereSeenFromNearby) {
  Scene scene = empty_scene(1e-3, 8);
  scene.materials.push_back({});
  scene.materials[0].surface.color = {0.7, 0.7, 0.7};
  ObjectScene ball;
  ball.kind = ObjectScene::Kind::sphere;
  ball.center = dvec3(0, 0, -100);
  ball.radius = 100;
  scene.objects.push_back(ball);
  scene.camera.position = dvec3(0, 0, 5e-4);
  scene.camera.look_at = dvec3(0, 0, 0);
  scene.lights.push_back(constant_environment(1));
  for (const double mean : mean_rgb(take(scene, 256).image)) EXPECT_NEAR(mean, 0.7, 0.005);
}

TEST(Transport, DiffuseSphereInAFurnace) {
  // Albedo a in a constant environment: a convex body shows exactly a.
  Scene scene = empty_scene(1, 24);
  MaterialSpec material;
  material.surface.color = {0.8, 0.8, 0.8};
  scene.materials.push_back(material);
  ObjectScene ball;
  ball.kind = ObjectScene::Kind::sphere;
  ball.radius = 2;
  ball.center = dvec3(0, 0, 0);
  scene.objects.push_back(ball);
  scene.camera.position = dvec3(0, 0, 5);
  scene.lights.push_back(constant_environment(1));
  expect_mean(scene, 0.8, 256);
}

}  // namespace
}  // namespace wale::test
