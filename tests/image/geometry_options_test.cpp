// Joints, normals and precision as scene keys: pictures change where they should, and nowhere else.
#include <gtest/gtest.h>

#include <cmath>

#include "geom/error.h"
#include "host/features.h"
#include "tests/image/picture.h"
#include "tests/image/program.h"
#include "tests/temporary_folder.h"

namespace wale::test {
namespace {

Scene cloth(const std::vector<std::string>& overrides, int size = 24) {
  const TemporaryFolder folder;
  return read_scene(folder.write("scene.json", everything_scene(size, 30)), overrides);
}

/// Pixels that differ by more than roundings: of which a path went elsewhere.
int moved(const Image& a, const Image& b) {
  int count = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) count += std::abs(a.at(x, y)[1] - b.at(x, y)[1]) > 1e-3f * b.at(x, y)[1];
  return count;
}

TEST(GeometryOptions, DefaultsChangeNothingAndLevelsChangeThePicture) {
  const std::string coarse = "fabrics.0.tolerance=0.3";
  const Image plain = take(cloth({coarse}), 4, 1).image;
  EXPECT_EQ(plain.pixels, take(cloth({coarse, "integrator.joints=mitre", "integrator.normals=rotation-minimising",
                                      "integrator.precision=float"}),
                               4, 1)
                              .image.pixels);
  for (const char* level : {"joints=open", "joints=capsule", "normals=flat", "normals=linear"})
    EXPECT_GT(moved(plain, take(cloth({coarse, std::string("integrator.") + level}), 4, 1).image), 20) << level;
}

// Yarns that run straight have no joints to see and one frame: joints and normals change roundings alone.
TEST(GeometryOptions, AStraightYarnLooksTheSame) {
  const auto picture = [](const std::string& joints, const std::string& normals) {
    Scene scene = empty_scene(0.006, 20);
    add_fabric(scene, straight_yarn(0.002, 0.0009), 0.02, 0.006, 1, "wool", Rgb{0.8, 0.6, 0.4}, 0);
    scene.lights.push_back(constant_environment(1));
    scene.integrator.joints = joints;
    scene.integrator.normals = normals;
    scene.integrator.max_depth = 2;
    return take(scene, 8, 1).image;
  };
  const Image plain = picture("mitre", "rotation-minimising");
  EXPECT_GT(mean_rgb(plain)[0], 0.1);
  for (const auto& [joints, normals] : std::vector<std::pair<std::string, std::string>>{
           {"open", "rotation-minimising"}, {"capsule", "rotation-minimising"}, {"mitre", "flat"}, {"mitre", "linear"}})
    EXPECT_LE(moved(plain, picture(joints, normals)), 8) << joints << ", " << normals;  // of 400: one path each
}

TEST(GeometryOptions, DoubleIsTheSamePictureWithinNoise) {
  if (!device().traits().fp64) GTEST_SKIP() << "the device has no fp64";
  const Picture twice = take(cloth({"integrator.precision=double"}), 32, 1);
  const Image other_seed = take(cloth({}), 32, 2).image;
  size_t tests = 0;
  const double p = smallest_p(twice.image, other_seed, tests);
  EXPECT_GT(p, sidak(0.01, tests));
  EXPECT_EQ(bad_events(twice.counts), 0u);
  // Of one scattering event the same seed follows the same paths; bounces would magnify roundings.
  const std::string once = "integrator.max_depth=1";
  const Image a = take(cloth({once}), 8, 1).image, b = take(cloth({once, "integrator.precision=double"}), 8, 1).image;
  EXPECT_LE(moved(a, b), a.width * a.height / 50);
  EXPECT_GT(different_pixels(a, b), size_t(a.width));
}

TEST(GeometryOptions, QuantisedVerticesAreTheSamePictureWithinNoise) {
  const Picture quantised = take(cloth({"integrator.vertices=quantised"}), 32, 1);
  const Image other_seed = take(cloth({}), 32, 2).image;
  size_t tests = 0;
  const double p = smallest_p(quantised.image, other_seed, tests);
  EXPECT_GT(p, sidak(0.01, tests));
  EXPECT_EQ(bad_events(quantised.counts), 0u);
}

TEST(GeometryOptions, DoubleNeedsADeviceThatHasIt) {
  DeviceTraits traits = device().traits();
  traits.fp64 = false;
  const Scene scene = cloth({"integrator.precision=double"}, 8);
  const World world = build_world(scene, {});
  try {
    analyse(world, scene.integrator, false, traits);
    FAIL() << "was not refused";
  } catch (const Error& e) {
    EXPECT_EQ(e.fault(), Fault::user);
    EXPECT_NE(std::string(e.what()).find("use \"float\""), std::string::npos) << e.what();
  }
  EXPECT_THROW(cloth({"integrator.precision=double", "integrator.lanes=16"}), Error);
}

}  // namespace
}  // namespace wale::test
