// Feature images: what the first hit was, in places of the world, and nothing where nothing was met.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/image/picture.h"

namespace wale::test {
namespace {

size_t channel(const Image& image, const std::string& name) {
  const auto found = std::find(image.channels.begin(), image.channels.end(), name);
  EXPECT_NE(found, image.channels.end()) << name;
  return size_t(found - image.channels.begin());
}

// A ball and a strip of cloth, far from the world's zero, on nothing. The picture is many waves of 64 paths.
TEST(Features, PlacesAreOfTheWorldAndAbsentInTheBackground) {
  const dvec3 far(40, -20, 7);
  Scene scene = empty_scene(0.01, 24);
  scene.camera.position += far;
  scene.camera.look_at = far;
  scene.film.filter = "tent";
  add_fabric(scene, straight_yarn(0.002, 0.0007), 0.006, 0.004, 2, "wool", Rgb{1, 1, 1});
  scene.fabrics[0].transform.translate = far;
  scene.materials.push_back({});
  ObjectScene ball;
  ball.kind = ObjectScene::Kind::sphere;
  ball.center = far + dvec3(0.002, 0.0035, 0.01);
  ball.radius = 0.0012;
  ball.material = int(scene.materials.size()) - 1;
  scene.objects.push_back(ball);
  scene.lights.push_back(constant_environment(1));

  const Image image = take(scene, 4, 1, 64, true).image;
  const size_t depth = channel(image, "depth.Z"), ply = channel(image, "ply.id"), albedo = channel(image, "albedo.R");
  const size_t position = channel(image, "position.X"), normal = channel(image, "normal.X");
  size_t empty = 0, cloth = 0, other = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const float* v = image.at(x, y);
      if (v[depth] == 0) {
        ++empty;
        EXPECT_EQ(v[ply], -1);
        for (const size_t c : {albedo, position, position + 1, position + 2, normal, normal + 2}) EXPECT_EQ(v[c], 0);
        continue;
      }
      ++(v[ply] >= 0 ? cloth : other);
      const double half = 0.005, step = 0.01 / image.width;  // the tent filter reaches one pixel
      EXPECT_NEAR(v[position], far.x - half + (x + 0.5) * step, step) << x << " " << y;
      EXPECT_NEAR(v[position + 1], far.y + half - (y + 0.5) * step, step) << x << " " << y;
      EXPECT_NEAR(v[position + 2] + v[depth], scene.camera.position.z, 1e-5) << x << " " << y;
      EXPECT_GT(v[normal + 2], 0);
    }
  EXPECT_GT(empty, 50u);
  EXPECT_GT(cloth, 50u);
  EXPECT_GT(other, 10u);
}

// A single ply along x in front of nothing, far from the world's zero: positions come back in world coordinates, what
// the camera misses is empty, and several waves do not leak into each other.
TEST(Features, StraightPlyInAnEmptyWorld) {
  Scene scene = empty_scene(0.002, 40);
  add_fabric(scene, straight_yarn(0.002, 0.0005), 0.006, 0.002, 1, "wool", std::nullopt);
  scene.materials[0].yarn.optical_radius = 100;  // nothing passes through where the ply is thick
  const dvec3 away(3, -2, 7);
  scene.fabrics[0].transform.translate = away;
  scene.camera.position += away;
  scene.camera.look_at += away;
  scene.lights.push_back(constant_environment(1));
  const Image image = take(scene, 8, 0, 1000, true).image;
  const size_t ply = channel(image, "ply.id"), depth = channel(image, "depth.Z"), x = channel(image, "position.X"),
               nz = channel(image, "normal.Z"), tx = channel(image, "tangent.X"), samples = channel(image, "samples");
  int hits = 0;
  for (int row = 0; row < image.height; ++row)
    for (int column = 0; column < image.width; ++column) {
      const float* v = image.at(column, row);
      ASSERT_TRUE(std::all_of(v, v + image.channels.size(), [](float f) { return std::isfinite(f); }));
      EXPECT_EQ(v[samples], 8);
      // Rows within 0.0004 m of the axis always meet the ply, rows beyond its radius never do.
      const double y = 0.002 * (0.5 - (row + 0.5) / image.height);
      const double world_x = away.x + 0.002 * ((column + 0.5) / image.width - 0.5);
      if (std::abs(y) < 0.0003) {
        ++hits;
        EXPECT_EQ(v[ply], image.at(20, 20)[ply]);
        EXPECT_GE(v[ply], 0);
        EXPECT_NEAR(v[x], world_x, 4e-5);
        EXPECT_NEAR(v[x + 2], away.z + std::sqrt(0.0005 * 0.0005 - y * y), 3e-5);
        EXPECT_NEAR(v[depth], 0.02 - std::sqrt(0.0005 * 0.0005 - y * y), 3e-5);
        EXPECT_GT(v[nz], 0.7);
        EXPECT_NEAR(std::abs(v[tx]), 1, 1e-3);
      } else if (std::abs(y) > 0.00053) {
        EXPECT_EQ(v[ply], -1);
        EXPECT_EQ(v[depth], 0);
      }
    }
  EXPECT_GT(hits, 400);
}

// A scene without a camera shows all of its cloth, in a picture of any shape.
TEST(Features, FramingKeepsTheClothInside) {
  for (const auto& [width, height] : {std::pair(24, 72), std::pair(72, 24)}) {
    Scene scene = empty_scene(0.01, 16);
    scene.camera_given = false;
    scene.camera.orthographic = false;
    scene.film.width = width;
    scene.film.height = height;
    add_fabric(scene, straight_yarn(0.004, 0.0015), 0.08, 0.08, 1, "wool", Rgb{1, 1, 1});
    const Image image = take(scene, 8, 1, 0, true).image;
    const size_t depth = channel(image, "depth.Z");
    size_t cloth = 0;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const bool hit = image.at(x, y)[depth] > 0, border = x == 0 || y == 0 || x == width - 1 || y == height - 1;
        cloth += hit;
        EXPECT_FALSE(hit && border) << x << " " << y;
      }
    EXPECT_GT(cloth, 30u);
  }
}

}  // namespace
}  // namespace wale::test
