#include "tests/hard/fixtures_lights.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geom/base_mesh_generators.h"
#include "host/image.h"
#include "tests/hard/fixtures_scenes.h"
#include "tests/kernels/fabric_tracer.h"

namespace wale::test {
namespace {

using std::numbers::pi;

constexpr double kSheet = 0.006, kGrey = 0.6;

BaseMesh sheet() { return make_swatch(kSheet, kSheet, 4, 4); }

void add_ground(Scene& scene, double albedo) {
  MaterialSpec material;
  material.surface.color = {albedo, albedo, albedo};
  ObjectScene ground;
  ground.kind = ObjectScene::Kind::ground;
  ground.up = dvec3(0, 0, 1);
  ground.extent = 100;
  ground.material = int(scene.materials.size());
  scene.materials.push_back(material);
  scene.objects.push_back(ground);
}

// A square millimetre of ground, seen from 0.2 m above it.
Scene ground() {
  Scene scene = empty_scene(1e-3, 16);
  scene.camera.position = dvec3(0, 0, 0.2);
  add_ground(scene, kGrey);
  return scene;
}

LightScene sphere_light(dvec3 position, double radius, double radiance) {
  LightScene light;
  light.kind = LightScene::Kind::sphere;
  light.position = position;
  light.radius = radius;
  light.radiance = {radiance, radiance, radiance};
  return light;
}

ConstantPicture cloth_inside(double radius, double view) {
  Scene scene = empty_scene(view, 16);
  scene.camera.position = dvec3(0, 0, 0.002);
  add_cloth(scene, sheet());
  scene.lights.push_back(sphere_light(dvec3(0), radius, 1));
  return {scene};
}

// Vertices of the scene's first fabric as the device places them, metres.
std::vector<dvec3> ply_points(const Scene& scene) {
  const World world = build_world(scene, Loaders{[](const auto& file) { return read_mesh(file); }, {}});
  const std::vector<float> words = FabricTracer(device(), world.fabrics[0]).positions();
  std::vector<dvec3> points;
  for (size_t i = 0; i < words.size(); i += 3) points.emplace_back(words[i], words[i + 1], words[i + 2]);
  return points;
}

constexpr int kSkyWidth = 64, kSkyHeight = 32, kHotX = 40, kHotY = 6;
constexpr double kHot = 1e6;

double sky_texel(int x, int y) {
  return (x + kSkyWidth) % kSkyWidth == kHotX && std::clamp(y, 0, kSkyHeight - 1) == kHotY ? kHot : 1;
}

LightScene hot_sky() {
  Image image;
  image.width = kSkyWidth;
  image.height = kSkyHeight;
  image.channels = {"R", "G", "B"};
  for (int y = 0; y < kSkyHeight; ++y)
    for (int x = 0; x < kSkyWidth; ++x)
      for (int c = 0; c < 3; ++c) image.pixels.push_back(float(sky_texel(x, y)));
  LightScene light;
  light.kind = LightScene::Kind::environment;
  light.file = fixture_file(".exr");
  light.env_up = dvec3(0, 0, 1);
  write_image(image, light.file);
  return light;
}

// Mean over the hemisphere about `up` of the map, weighted by the cosine: bilinear between texel centres, in double.
double sky_irradiance_over_pi() {
  constexpr int kFine = 16;
  double sum = 0;
  for (int j = 0; j < kSkyHeight * kFine / 2; ++j) {
    const double v = (j + 0.5) / kFine, theta = pi * v / kSkyHeight;
    for (int i = 0; i < kSkyWidth * kFine; ++i) {
      const double x = (i + 0.5) / kFine - 0.5, y = v - 0.5;
      const int x0 = int(std::floor(x)), y0 = int(std::floor(y));
      const double ax = x - x0, ay = y - y0;
      const double value = (1 - ay) * ((1 - ax) * sky_texel(x0, y0) + ax * sky_texel(x0 + 1, y0)) +
                           ay * ((1 - ax) * sky_texel(x0, y0 + 1) + ax * sky_texel(x0 + 1, y0 + 1));
      sum += value * std::cos(theta) * std::sin(theta);
    }
  }
  return sum * (pi / kSkyHeight / kFine) * (2 * pi / kSkyWidth / kFine) / pi;
}

}  // namespace

ConstantPicture ground_under_a_speck() {
  Scene scene = ground();
  scene.lights.push_back(sphere_light(dvec3(0, 0, 1e4), 1e-9, 1e26));
  return {scene, kGrey};  // irradiance pi L (r/d)^2
}

ConstantPicture ground_under_a_far_giant() {
  Scene scene = ground();
  scene.lights.push_back(sphere_light(dvec3(0, 0, 1e6), 5e5, 4));
  return {scene, kGrey};
}

ConstantPicture ground_beside_a_quad_in_its_plane() {
  Scene scene = ground();
  LightScene light;
  light.position = dvec3(0.5, 0, 0);
  light.look_at = dvec3(-1, 0, 0);  // stands on edge across the ground; its lower half lies below
  light.up = dvec3(0, 0, 1);
  light.two_sided = true;
  light.radiance = {3, 3, 3};
  light.width = light.height = 0.4;
  LightScene flat = light;
  flat.look_at = dvec3(0.5, 0, 1);
  flat.up = dvec3(1, 0, 0);
  scene.lights = {flat, constant_environment(1)};
  return {scene, kGrey};
}

ConstantPicture cloth_inside_a_light() { return cloth_inside(0.05, 0.008); }

ConstantPicture cloth_through_a_light() { return cloth_inside(0.0049, 0.005); }

ConstantPicture cloth_touched_by_a_light() {
  Scene scene = white_furnace(sheet(), 0.005, 16);
  double top = -1;
  for (const dvec3& p : ply_points(scene)) top = std::max(top, p.z);
  const World world = build_world(scene, Loaders{[](const auto& file) { return read_mesh(file); }, {}});
  top += world.fabrics[0].ply_radius;
  LightScene light;
  light.position = dvec3(0, 0, top);
  light.look_at = dvec3(0, 0, -1);
  light.width = light.height = 0.02;
  scene.lights.push_back(light);
  scene.camera.position = dvec3(0, 0, -0.05);
  return {scene};
}

ConstantPicture camera_inside_a_ply() {
  Scene scene = white_furnace(sheet(), 0.005, 16);
  const std::vector<dvec3> points = ply_points(scene);
  const auto nearest = std::min_element(points.begin(), points.end(),
                                        [](const dvec3& a, const dvec3& b) { return glm::length(a) < glm::length(b); });
  scene.camera.orthographic = false;
  scene.camera.fov = 1.5;
  scene.camera.position = *nearest;
  scene.camera.look_at = *nearest + dvec3(1e-3, 2e-4, 0);
  scene.camera.up = dvec3(0, 0, 1);
  return {scene};
}

ConstantPicture camera_along_the_cloth() {
  Scene scene = white_furnace(sheet(), 0.006, 16);
  scene.camera.position = dvec3(-0.05, 0, 0);
  scene.camera.up = dvec3(0, 0, 1);
  return {scene};
}

ConstantPicture furnace_of(double radiance) {
  Scene scene = white_furnace(sheet(), 0.008, 16);
  scene.lights = {constant_environment(radiance)};
  return {scene, radiance};
}

ConstantPicture furnace_through(double fov) {
  Scene scene = white_furnace(sheet(), 0.008, 16);
  scene.camera.orthographic = false;
  scene.camera.fov = fov;
  scene.camera.position = glm::normalize(dvec3(0.3, 0.2, 1)) * (0.003 / std::tan(0.5 * fov));
  return {scene};
}

ConstantPicture furnace_on_one_pixel() {
  Scene scene = white_furnace(sheet(), 0.005, 1);
  scene.film.filter = "tent";
  return {scene};
}

ConstantPicture two_cloths_in_one_place() {
  Scene scene = white_furnace(sheet(), 0.008, 16);
  add_cloth(scene, sheet());
  return {scene};
}

ConstantPicture two_grounds_in_one_place() {
  Scene scene = empty_scene(1, 16);
  add_ground(scene, 1);
  add_ground(scene, 1);
  scene.camera.position = dvec3(1, 2, 3);
  scene.lights.push_back(constant_environment(1));
  return {scene};
}

ConstantPicture ground_under_a_hot_pixel() {
  Scene scene = ground();
  scene.lights.push_back(hot_sky());
  return {scene, kGrey * sky_irradiance_over_pi()};
}

Scene cloth_under_a_hot_pixel() {
  Scene scene = white_furnace(sheet(), 0.005, 16);
  scene.lights = {hot_sky()};
  return scene;
}

}  // namespace wale::test
