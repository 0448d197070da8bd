#include "tests/hard/fixtures_transforms.h"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "geom/base_mesh_generators.h"
#include "tests/hard/fixtures_scenes.h"

namespace wale::test {
namespace {

BaseMesh transformed(BaseMesh mesh, const Similarity& at) {
  for (dvec3& p : mesh.position) p = at.point(p);
  for (auto& t : mesh.uv)
    for (dvec2& uv : t) uv *= at.scale;
  compute_normals(mesh);
  return mesh;
}

std::filesystem::path scaled_stockinette(double scale) {
  Pattern pattern = stockinette_pattern();
  pattern.period *= scale;
  pattern.yarn_radius *= scale;
  for (PatternCurve& curve : pattern.curves)
    for (dvec3& p : curve.points) p *= scale;
  const auto file = fixture_file(".json");
  write_pattern_json(pattern, file);
  return file;
}

void add_draped(Scene& scene, const Similarity& at) {
  FabricScene& fabric = add_cloth(scene, transformed(make_draped_square(0.016, 0.004, 12), at), {0.8, 0.4, 0.2});
  fabric.pattern.builtin.clear();
  fabric.pattern.file = scaled_stockinette(at.scale);
}

void add_props(Scene& scene, const Similarity& at) {
  MaterialSpec grey;
  grey.name = "grey";
  scene.materials.push_back(grey);
  ObjectScene ball;
  ball.kind = ObjectScene::Kind::sphere;
  ball.center = at.point(dvec3(0));
  ball.radius = 0.0035 * at.scale;
  ball.material = int(scene.materials.size()) - 1;
  ObjectScene ground = ball;
  ground.kind = ObjectScene::Kind::ground;
  ground.up = at.direction(dvec3(0, 0, 1));
  ground.height = glm::dot(ground.up, at.point(dvec3(0, 0, -0.008)));
  ground.extent = 1 * at.scale;  // its border, out of sight, is where its axes happen to lie
  scene.objects = {ball, ground};
}

void add_lights(Scene& scene, const Similarity& at) {
  LightScene quad;
  quad.position = at.point(dvec3(-0.02, 0.01, 0.02));
  quad.look_at = at.point(dvec3(0));
  quad.up = at.direction(dvec3(0, 1, 0));
  quad.width = quad.height = 0.01 * at.scale;
  quad.radiance = {4, 5, 6};
  LightScene ball;
  ball.kind = LightScene::Kind::sphere;
  ball.position = at.point(dvec3(0.02, 0.01, 0.01));
  ball.radius = 0.003 * at.scale;
  ball.radiance = {20, 15, 10};
  scene.lights = {quad, ball, constant_environment(0.5)};
}

}  // namespace

dmat3 rotation(dvec3 axis, double angle) { return dmat3(glm::rotate(glm::dmat4(1.0), angle, glm::normalize(axis))); }

Scene draped_scene(const Similarity& at, int pixels) {
  Scene scene = empty_scene(1, pixels);
  add_draped(scene, at);
  add_props(scene, at);
  add_lights(scene, at);
  CameraScene& camera = scene.camera;
  camera.orthographic = false;
  camera.fov = 0.6;
  camera.position = at.point(dvec3(0.005, -0.02, 0.025));
  camera.look_at = at.point(dvec3(0, 0, 0.001));
  camera.up = at.direction(dvec3(0, 0, 1));
  camera.aperture = 0.0005 * at.scale;
  return scene;
}

Scene two_cloths_apart(double distance) {
  Scene scene = draped_scene({}, 8);
  add_draped(scene, {1, dmat3(1.0), dvec3(distance, 0, 0)});
  return scene;
}

Scene seen_from_afar(double fov, int pixels) {
  Scene scene = draped_scene({}, pixels);
  scene.camera.aperture = 0;
  scene.camera.fov = fov;
  const dvec3 to_camera = glm::normalize(dvec3(0.005, -0.02, 0.025));
  scene.camera.position = scene.camera.look_at + to_camera * (0.01 / std::tan(0.5 * fov));
  return scene;
}

}  // namespace wale::test
