// First-hit feature images.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/image/picture.h"

namespace wale::test {
namespace {

int channel(const Image& image, const std::string& name) {
  const auto found = std::find(image.channels.begin(), image.channels.end(), name);
  EXPECT_NE(found, image.channels.end()) << name;
  return int(found - image.channels.begin());
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
  const int ply = channel(image, "ply.id"), depth = channel(image, "depth.Z"), x = channel(image, "position.X"),
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

}  // namespace
}  // namespace wale::test
