// Meshes, tiles and a sky that nobody made for this project, from file to picture. The full-size pictures:
// bench/real_inputs.py.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "geom/base_mesh.h"
#include "host/image.h"
#include "tests/image/picture.h"

namespace wale::test {
namespace {

std::filesystem::path real_data() {
  const char* folder = std::getenv("WALE_REAL_DATA");
  return folder ? folder : "";
}

Scene real_scene(const std::string& mesh, const std::string& tile, const dvec3& from, const dvec3& to, double fov) {
  Scene scene;
  scene.camera_given = true;
  scene.camera.position = from;
  scene.camera.look_at = to;
  scene.camera.fov = fov * M_PI / 180;
  scene.film.width = scene.film.height = 96;
  MaterialSpec material;
  material.ply = true;
  material.yarn.color = Rgb{0.97, 0.93, 0.85};
  scene.materials.push_back(material);
  FabricScene fabric;
  fabric.spec.name = "cloth";
  fabric.spec.scale.kind = FabricScale::Kind::gauge;
  fabric.spec.scale.gauge = dvec2(500, 0);  // 5 wales per cm
  fabric.mesh.file = real_data() / "meshes" / mesh;
  fabric.pattern.file = real_data() / "yarn-patterns/madypg" / tile;
  scene.fabrics.push_back(fabric);
  return scene;
}

LightScene small_light(const dvec3& position, const dvec3& to) {
  LightScene light;
  light.position = position;
  light.look_at = to;
  light.width = light.height = 0.08;
  light.radiance = {100, 100, 100};
  return light;
}

// Every value finite, nothing rare, and the cloth fills a plausible part of the picture.
void expect_sound(const Picture& picture, double least, double most) {
  for (const float v : picture.image.pixels) ASSERT_TRUE(std::isfinite(v));
  EXPECT_EQ(bad_events(picture.counts), 0u);
  size_t covered = 0;
  const auto& channels = picture.image.channels;
  const size_t stride = channels.size(),
               ply = size_t(std::find(channels.begin(), channels.end(), "ply.id") - channels.begin());
  ASSERT_LT(ply, stride);
  for (size_t i = 0; i < picture.image.pixels.size(); i += stride) covered += picture.image.pixels[i + ply] >= 0;
  const double share = double(covered) * double(stride) / double(picture.image.pixels.size());
  EXPECT_GT(share, least);
  EXPECT_LT(share, most);
}

const dvec3 kSockFrom(-0.146, -0.05, 0.75), kSockTo(-0.146, -0.112, -0.017);

TEST(RealInputs, SockInRibUnderAPhotographedSky) {
  if (real_data().empty()) GTEST_SKIP() << "real data not present";
  Scene scene = real_scene("madypg/sock_cloth.obj", "cartridge_belt_rib.pyp", kSockFrom, kSockTo, 23);
  LightScene sky = constant_environment(1);
  sky.file = real_data() / "envmaps/pmndrs/venice.exr";
  scene.lights.push_back(sky);
  const Picture picture = take(scene, 8, 0, 0, true);
  expect_sound(picture, 0.15, 0.5);
  for (const double mean : mean_rgb(picture.image)) EXPECT_GT(mean, 0.05);
}

TEST(RealInputs, SockInStockinetteLitFromTheFrontAndFromBehind) {
  if (real_data().empty()) GTEST_SKIP() << "real data not present";
  Scene scene = real_scene("madypg/sock_cloth.obj", "stockinette.pyp", kSockFrom, kSockTo, 23);
  scene.lights.push_back(small_light({-0.45, 0.25, 0.6}, kSockTo));
  const Picture front = take(scene, 8, 0, 0, true);
  expect_sound(front, 0.15, 0.5);
  scene.lights[0] = small_light({0.25, 0.2, -0.55}, kSockTo);
  const Picture back = take(scene, 8, 0, 0, true);
  expect_sound(back, 0.15, 0.5);
  // Knits let light through: seen against the light the cloth is of the same order of brightness, neither black nor a
  // window.
  const double reflected = mean_rgb(front.image)[0], transmitted = mean_rgb(back.image)[0];
  EXPECT_GT(transmitted, 0.1 * reflected);
  EXPECT_LT(transmitted, 3 * reflected);
}

TEST(RealInputs, SpotTheCow) {
  if (real_data().empty()) GTEST_SKIP() << "real data not present";
  Scene scene = real_scene("spot/spot_triangulated.obj", "stockinette.pyp", {-2.4, 1.2, -3.0}, {0, 0.1, 0.1}, 32);
  scene.fabrics[0].spec.scale.kind = FabricScale::Kind::repeats;
  scene.fabrics[0].spec.scale.repeats = dvec2(20, 40);
  scene.lights.push_back(constant_environment(1));
  expect_sound(take(scene, 8, 0, 0, true), 0.15, 0.5);
}

}  // namespace
}  // namespace wale::test
