// A picture depends on what the scene holds, not on what its kernels could do besides: structure that is built in and
// not called for changes no bit of it, and the program that a scene's kernels are is its structure's alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <utility>

#include "geom/base_mesh.h"
#include "host/image.h"
#include "host/stages.h"
#include "tests/image/picture.h"

namespace wale::test {
namespace {

const Loaders& loaders() {
  static const Loaders both{[](const auto& file) { return read_mesh(file); },
                            [](const auto& file) { return read_image(file, true); }};
  return both;
}

struct Built {
  World world;
  SceneDevice on_device;
  IntegratorScene integrator;
  Built(const Device& dev, const Scene& scene)
      : world(build_world(scene, loaders())),
        on_device(dev, world),
        integrator(scene.integrator) {}
  Rendered render_with(const Device& dev, const Features& also, bool aovs = false) const {
    RenderOptions options;
    options.spp = 8;
    options.aovs = aovs;
    options.also = also;
    return render(dev, world, on_device, integrator, options);
  }
};

// Values that differ in any bit among the channels that both have: means and their variances come first.
size_t different_values(const Image& a, const Image& b) {
  const size_t common = std::min(a.channels.size(), b.channels.size());
  size_t different = a.width != b.width || a.height != b.height || common < 6;
  for (int y = 0; y < a.height && !different; ++y)
    for (int x = 0; x < a.width; ++x)
      for (size_t c = 0; c < common; ++c) different += std::memcmp(a.at(x, y) + c, b.at(x, y) + c, sizeof(float)) != 0;
  return different;
}

bool is_lit(const Image& image) {
  const auto mean = mean_rgb(image);
  return mean[0] > 0.01 && mean[1] > 0.01;
}

class Bundled : public testing::TestWithParam<std::filesystem::path> {};

// Large cloths are knitted more coarsely, so that the test is short: the structure is the scene's own.
Scene small(const std::filesystem::path& file) {
  constexpr double kSegments = 1e5;
  Scene scene = read_scene(file, {"film.size=[24,24]"});
  for (FabricScene& fabric : scene.fabrics) {
    const double segments =
        double(estimate_segments(load_mesh(fabric.mesh, loaders()), load_pattern(fabric.pattern), fabric.spec));
    const double coarser = std::sqrt(std::min(1.0, kSegments / segments));
    fabric.spec.scale.gauge *= coarser;
    fabric.spec.scale.repeats *= coarser;
  }
  return scene;
}

std::vector<std::filesystem::path> bundled_scenes() {
  std::vector<std::filesystem::path> scenes;
  for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(WALE_SOURCE_DIR) / "scenes"))
    if (entry.path().extension() == ".json") scenes.push_back(entry.path());
  std::sort(scenes.begin(), scenes.end());
  return scenes;
}

TEST_P(Bundled, EverythingBuiltInGivesTheSamePicture) {
  const Built built(device(), small(GetParam()));
  const Rendered needed = built.render_with(device(), {}), all = built.render_with(device(), Features::everything());
  EXPECT_TRUE(is_lit(needed.image));
  EXPECT_GT(all.image.channels.size(), needed.image.channels.size()) << "features of the first hit are built in";
  EXPECT_EQ(different_values(needed.image, all.image), 0u);
  EXPECT_EQ(needed.counts.shadow, all.counts.shadow);
  EXPECT_EQ(needed.counts.bounce, all.counts.bounce);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Bundled, testing::ValuesIn(bundled_scenes()),
                         [](const auto& scene) { return scene.param.stem().string(); });

// A plain cloth under a lamp; nothing of what is built in beside it is there.
Scene plain_scene() {
  Scene scene = empty_scene(0.006, 24);
  add_fabric(scene, straight_yarn(0.002, 0.0007), 0.006, 0.004, 2, "wool", Rgb{0.8, 0.5, 0.3});
  scene.fabrics[0].spec.detail = Detail::none;
  LightScene lamp;
  lamp.kind = LightScene::Kind::sphere;
  lamp.position = dvec3(0.02, 0.02, 0.05);
  lamp.radius = 0.01;
  lamp.radiance = {20, 20, 20};
  scene.lights.push_back(lamp);
  return scene;
}

// Two at a time, each in another pair than those that share its code; one at a time in the long tests.
TEST(Neutrality, WhatOtherScenesNeedLeavesAPictureAsItIs) {
  using Members = std::vector<bool Features::*>;
  const Built built(device(), plain_scene());
  const Image expected = built.render_with(device(), {}).image;
  ASSERT_TRUE(is_lit(expected));
  std::vector<Members> sets = {{&Features::fibres, &Features::aovs},
                               {&Features::procedural, &Features::environment},
                               {&Features::triangles, &Features::ply_colors},
                               {&Features::detail, &Features::lights}};
  if (const char* long_tests = std::getenv("WALE_LONG_TESTS"); long_tests && std::string(long_tests) == "1") {
    const std::vector<Members> pairs = std::exchange(sets, {});
    for (const Members& pair : pairs)
      for (const auto member : pair) sets.push_back({member});
  }
  for (size_t i = 0; i < sets.size(); ++i) {
    Features also;
    for (const auto member : sets[i]) also.*member = true;
    EXPECT_EQ(different_values(expected, built.render_with(device(), also).image), 0u) << i << also.options();
  }
}

// Cloth in its colours, on a device of its own: its programs are counted.
size_t programs_after(const Device& dev, const Scene& scene) {
  EXPECT_TRUE(Built(dev, scene).render_with(dev, {}).reached.most == 8);
  return dev.programs().programs.size();
}

TEST(Neutrality, NoColourLightOrCameraMakesAnotherProgram) {
  const Device dev = Device::open();
  const Scene scene = plain_scene();
  const size_t programs = programs_after(dev, scene);
  ASSERT_GT(programs, 3u);
  const auto changed = [&](const auto& change) {
    Scene other = scene;
    change(other);
    return programs_after(dev, other);
  };
  EXPECT_EQ(changed([](Scene& s) { s.materials[0].yarn.color = Rgb{0, 0, 0}; }), programs) << "colour";
  EXPECT_EQ(changed([](Scene& s) { s.materials[0].yarn.optical_radius = 5000; }), programs) << "opaque plies";
  EXPECT_EQ(changed([](Scene& s) { s.lights[0].radiance = {1, 2, 3}; }), programs) << "radiance";
  EXPECT_EQ(changed([](Scene& s) { s.lights[0].radiance = {0, 0, 0}; }), programs) << "no light";
  EXPECT_EQ(changed([](Scene& s) { s.lights[0].position = dvec3(-3, 0, -5); }), programs) << "place of the light";
  EXPECT_EQ(changed([](Scene& s) { s.lights.push_back(s.lights[0]); }), programs) << "one light more of its kind";
  EXPECT_EQ(changed([](Scene& s) { s.camera.position = dvec3(0.01, 0, 3); }), programs) << "camera";
  EXPECT_EQ(changed([](Scene& s) {
              s.camera.orthographic = false;
              s.camera.aperture = 0.001;
            }),
            programs)
      << "lens";
  EXPECT_EQ(changed([](Scene& s) { s.integrator.max_depth = 3; }), programs) << "depth";
  EXPECT_EQ(changed([](Scene& s) { s.film.width = 17; }), programs) << "film";
  EXPECT_GT(changed([](Scene& s) { s.lights.push_back(constant_environment(1)); }), programs) << "structure does";
}

// One program of each stage is the most that a render ever compiles, whatever its scene calls for.
TEST(Neutrality, ARenderCompilesOneProgramOfEachStageAtMost) {
  Features all = Features::everything();
  all.mesh_warp = all.stored_lattice = true;
  all.lanes = W_NODE_WIDTH;
  std::vector<Stage> stages = geometry_stages(all);
  for (auto& stage : wavefront_stages(all)) stages.push_back(stage);
  EXPECT_EQ(programs_of(stages, false).size(), kMostPrograms);
  const Device dev = Device::open();
  const Built built(dev, plain_scene());
  built.render_with(dev, Features::everything());
  EXPECT_LE(dev.programs().programs.size(), kMostPrograms);
  built.render_with(dev, Features::everything());
  EXPECT_LE(dev.programs().programs.size(), kMostPrograms);
}

}  // namespace
}  // namespace wale::test
