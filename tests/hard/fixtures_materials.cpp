#include "tests/hard/fixtures_materials.h"

#include <functional>
#include <numbers>

#include "geom/base_mesh_generators.h"
#include "tests/hard/fixtures_scenes.h"

namespace wale::test {
namespace {

constexpr int kPixels = 12;

Scene cloth(const std::function<void(PlyAppearance&)>& change) {
  Scene scene = white_furnace(make_swatch(0.006, 0.006, 4, 4), 0.005, kPixels);
  change(scene.materials[size_t(scene.fabrics[0].material)].yarn);
  return scene;
}

Scene ball(double color, double roughness, double ior) {
  Scene scene = empty_scene(1.5, kPixels);
  MaterialSpec material;
  material.surface = {true, {color, color, color}, roughness, ior};
  scene.materials.push_back(material);
  ObjectScene object;
  object.kind = ObjectScene::Kind::sphere;
  scene.objects.push_back(object);
  scene.lights.push_back(constant_environment(1));
  return scene;
}

}  // namespace

std::vector<Scene> white_plies_at_their_limits() {
  constexpr double kDegree = std::numbers::pi / 180;
  return {cloth([](auto& y) { y.roughness = 0; }),
          cloth([](auto& y) { y.roughness = 90 * kDegree; }),
          cloth([](auto& y) { y.ior = 1; }),
          cloth([](auto& y) { y.ior = 4; }),
          cloth([](auto& y) { y.optical_radius = 0; }),
          cloth([](auto& y) { y.optical_radius = 1e-6; }),
          cloth([](auto& y) { y.optical_radius = 1e4; }),
          cloth([](auto& y) { y.fibre_twist = 88.9 * kDegree; })};
}

std::vector<Scene> dark_and_coated_at_their_limits() {
  std::vector<Scene> scenes;
  for (const double color : {0.0, 1e-6}) scenes.push_back(cloth([&](auto& y) { y.color = Rgb{color, color, color}; }));
  for (const double color : {0.0, 1.0})
    for (const double roughness : {0.0, 1e-4, 1.0})
      for (const double ior : {1.0, 4.0}) scenes.push_back(ball(color, roughness, ior));
  return scenes;
}

}  // namespace wale::test
