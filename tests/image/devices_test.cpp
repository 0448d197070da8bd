// A render on several devices is the render on one: bit for bit where the devices are alike.
#include <gtest/gtest.h>

#include "host/stages.h"
#include "tests/image/picture.h"
#include "tests/image/program.h"
#include "tests/run_program.h"
#include "tests/temporary_folder.h"

namespace wale::test {
namespace {

/// Two of PoCL's CPU devices in one process: basic, which has one thread, and pthread.
const std::string kTwo = "POCL_DEVICES=basic pthread";

TEST(Devices, TwoGiveTheBytesOfOne) {
  const TemporaryFolder folder;
  const auto scene = folder.write("scene.json", everything_scene(48, 30));
  if (run_wale({"devices"}, {kTwo}).out.find("1: pthread") == std::string::npos)
    GTEST_SKIP() << "PoCL's two CPU devices are needed";
  std::vector<Image> images;
  // Small waves: blocks change hands, and the last ones are fought for.
  for (const auto& [devices, pool] : {std::pair("1", "65024"), {"all", "65024"}, {"1,0", "512"}}) {
    const auto picture = folder / (std::string(pool) + devices + ".exr");
    const Outcome run = run_wale({"render", scene.string(), "-o", picture.string(), "--spp", "20", "--quiet",
                                  "--device", devices, "--set", std::string("integrator.pool=") + pool},
                                 {kTwo}, 300);
    ASSERT_EQ(run.status, 0) << run.err;
    images.push_back(read_image(picture));
  }
  ASSERT_GT(images[0].channels.size(), 15u) << "features are compared too";
  EXPECT_EQ(different_pixels(images[0], images[1]), 0u);
  EXPECT_EQ(different_pixels(images[0], images[2]), 0u);
}

TEST(Devices, AFilmInSeveralBuffersIsTheSameFilm) {
  const TemporaryFolder folder;
  const Scene scene = read_scene(folder.write("scene.json", everything_scene(36, 30)));
  const Picture expected = take(scene, 20, 3, 4099, true);
  Device small = device();
  small.traits().max_alloc_bytes = 3 * 64 * 8 * sizeof(w_float4);  // three tiles; the picture has 25
  // Only the film splits: the scene goes up with the device as it is.
  const World world = build_world(scene, {});
  const SceneDevice on_device(device(), world);
  IntegratorScene integrator = scene.integrator;
  integrator.seed = 3;
  RenderOptions options;
  options.spp = 20;
  options.pool = 4099;
  options.aovs = true;
  const Rendered split = render(small, world, on_device, integrator, options);
  EXPECT_EQ(different_pixels(expected.image, split.image), 0u);
  EXPECT_EQ(FilmDevice(small, 36, 36, true).pieces(0, 1600).size(), 9u) << "the film lay in nine buffers";
}

TEST(Devices, WhatIsForeseenIsWhatIsFound) {
  const std::string fabric = R"({"name": "a", "mesh": {"generator": "swatch", "width": 10, "height": 10},
     "pattern": {"builtin": "stockinette"}, "gauge": {"wales": 30})";
  struct Case {
    std::string fabric, more;
  };
  const TemporaryFolder folder;
  for (const Case& c : {Case{"}", ""},
                        {R"(, "detail": "none"})", R"(, "lights": [{"type": "quad", "position": [0,0,9]}])"},
                        {R"(, "detail": "fibres"})", R"(, "integrator": {"light_sampling": "bsdf"})"},
                        {R"(, "detail": "paper"})", R"(, "integrator": {"ply_lobes": "paper", "local_stage": "cell"})"},
                        {R"(, "material": "y"})",
                         R"(, "materials": {"y": {"type": "ply", "preset": "wool", "heather": {"yarn": 0.1}}},
                            "lights": [{"type": "environment", "radiance": 1}, {"type": "sphere", "position": [0, 0, 9],
                            "radius": 1, "radiance": 0}], "objects": [{"type": "sphere", "center": [0,0,-5], "radius": 1}])"},
                        {R"(, "storage": "procedural"})", ""},
                        {R"(, "storage": "stored", "lattice": 2})", ""},
                        {"}", R"(, "objects": [{"type": "ground", "height": -9}])"}}) {
    const Scene scene = read_scene(folder.write(
        "scene.json", R"({"wale": 1, "units": "mm", "fabrics": [)" + fabric + c.fabric + "]" + c.more + "}"));
    const World world = build_world(scene, {});
    DeviceTraits traits;
    traits.lanes = 16;
    const Features foreseen = foresee(scene, true, traits), found = analyse(world, scene.integrator, true, traits);
    EXPECT_EQ(foreseen.options(), found.options()) << c.fabric << c.more;
    const std::vector<Stage> a = geometry_stages(foreseen), b = geometry_stages(found);
    for (size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i].used, b[i].used) << a[i].file << c.fabric;
  }
}

}  // namespace
}  // namespace wale::test
