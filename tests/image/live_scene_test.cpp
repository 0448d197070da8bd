// A scene that is edited: the picture is that of the edited scene made from nothing, and only what an edit touches is
// done again.
#include "host/live_scene.h"

#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "geom/error.h"
#include "tests/image/picture.h"
#include "tests/image/program.h"
#include "tests/temporary_folder.h"

namespace wale::test {
namespace {

class EditedScene : public ::testing::Test {
 protected:
  Scene version(const std::vector<std::string>& edits) const { return read_scene(file_, edits); }

  Image picture(const Scene& scene) const {
    RenderOptions options;
    options.spp = 8;
    return render(live_.devices(), live_.world(), scene.integrator, options).image;
  }

  void expect_that_of(const std::vector<std::string>& edits) const {
    const Scene scene = version(edits);
    EXPECT_EQ(different_pixels(picture(scene), take(scene, 8, scene.integrator.seed).image), 0u)
        << fmt::format("{}", fmt::join(edits, " "));
  }

  TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.write("scene.json", everything_scene(24, 30));
  Loaders loaders_{[](const auto& file) { return read_mesh(file); }, {}};
  LiveScene live_{std::span(&device(), 1), loaders_, {}};
};

struct Edit {
  std::string change;
  size_t knitted;
  bool fabrics;
};

TEST_F(EditedScene, RedoesWhatAnEditTouches) {
  const Redone first = live_.apply(version({}));
  EXPECT_EQ(first.knitted, live_.world().fabrics.size());
  EXPECT_TRUE(first.fabrics);
  const std::string material = live_.scene().materials[size_t(live_.scene().fabrics[0].material)].name;
  const Edit edits[] = {
      {"materials." + material + ".color=[0.1,0.5,0.9]", 0, false},
      {"materials." + material + ".gloss=0.9", 0, false},
      {"materials." + material + ".fibre_twist=50", 0, false},
      {"materials." + material + ".translucency=0.9", 0, true},  // leaves hold the optical radius
      {"camera.fov=20", 0, false},
      {"integrator.seed=5", 0, false},
      {"lights.0.intensity=0.3", 0, false},
      {"film.exposure=1", 0, false},
      {"fabrics.0.yarn.plies=2", 1, true},
      {"fabrics.0.gauge.wales=24", 1, true},
      {"integrator.joints=capsule", 0, true},
  };
  for (const Edit& edit : edits) {
    const Redone there = live_.apply(version({edit.change}));
    EXPECT_EQ(there.knitted, edit.knitted) << edit.change;
    EXPECT_EQ(there.fabrics, edit.fabrics) << edit.change;
    expect_that_of({edit.change});
    live_.apply(version({}));
  }
  expect_that_of({});
  const Redone nothing = live_.apply(version({}));
  EXPECT_EQ(nothing.knitted, 0u);
  EXPECT_FALSE(nothing.fabrics);
}

// Where fibres lie in a ply takes long to lay out, and most edits leave it.
TEST_F(EditedScene, LaysOutFibresAnewWhereTheyChangeOnly) {
  live_.apply(version({}));
  const std::string material = live_.scene().materials[size_t(live_.scene().fabrics[0].material)].name;
  const auto section = [&] { return live_.world().fibres.made.at(0).detail; };
  const auto before = section();
  for (const std::string& same : {"materials." + material + ".color=[0.1,0.5,0.9]", std::string("camera.fov=20"),
                                  std::string("fabrics.0.gauge.wales=24"), std::string("lights.0.intensity=2")}) {
    live_.apply(version({same}));
    EXPECT_EQ(section(), before) << same;
  }
  const std::string fewer = "materials." + material + ".fibres.count=20";
  live_.apply(version({fewer}));
  EXPECT_NE(section(), before);
  EXPECT_EQ(section()->section().fibres.size(), 20u);
  expect_that_of({fewer});
}

TEST_F(EditedScene, AnyRowOfEditsEndsInThePictureOfTheLast) {
  std::mt19937 random(7);
  const std::vector<std::vector<std::string>> values = {
      {"fabrics.0.gauge.wales=24", "fabrics.0.gauge.wales=28"}, {"fabrics.0.yarn.plies=1", "fabrics.0.yarn.plies=4"},
      {"fabrics.0.detail=none", "fabrics.0.detail=fibres"},     {"lights.0.intensity=0.5", "lights.0.intensity=2"},
      {"fabrics.0.pattern={\"builtin\":\"garter\"}"},           {"integrator.local_stage=cell"},
  };
  live_.apply(version({}));
  for (int step = 0; step < 12; ++step) {
    std::vector<std::string> edits;
    for (const auto& choices : values)
      if (random() % 3 == 0) edits.push_back(choices[random() % choices.size()]);
    live_.apply(version(edits));
    expect_that_of(edits);
  }
}

TEST_F(EditedScene, AWrongEditLeavesTheSceneBefore) {
  live_.apply(version({}));
  const Image before = picture(live_.scene());
  const size_t segments = live_.world().fabrics[0].report.segments;
  Scene wrong = version({"fabrics.0.gauge.wales=24"});
  wrong.objects.push_back({});  // a mesh that is not there, found after the fabric was knitted
  wrong.objects.back().name = "missing";
  wrong.objects.back().mesh.file = folder_ / "missing.obj";
  EXPECT_THROW(live_.apply(wrong), Error);
  Scene keeps_fabric = version({});
  keeps_fabric.objects = wrong.objects;
  EXPECT_THROW(live_.apply(keeps_fabric), Error) << "with a fabric that had been taken over";
  EXPECT_EQ(live_.world().fabrics[0].report.segments, segments);
  EXPECT_FALSE(live_.world().fabrics[0].runs.empty());
  EXPECT_EQ(different_pixels(before, picture(live_.scene())), 0u);
  EXPECT_EQ(live_.apply(version({"film.exposure=1"})).knitted, 0u);
}

TEST_F(EditedScene, OneWavefrontServesEditsOfValues) {
  live_.apply(version({}));
  const auto features = [&] {
    return features_of(device().traits(), live_.world(), live_.scene().integrator, {}).with(Features::everything());
  };
  Wavefront wave(device(), *live_.devices()[0].scene, features(), live_.world().camera, 4096);
  const Scene edited = version({"fabrics.0.gauge.wales=24", "camera.fov=20"});
  live_.apply(edited);
  const SceneDevice& scene = *live_.devices()[0].scene;
  ASSERT_TRUE(wave.serves(scene, features()));
  wave.rebind(scene, features(), live_.world().camera);
  Wavefront fresh(device(), scene, features(), live_.world().camera, 4096);
  WFrame frame{};
  frame.lights = uint32_t(live_.world().lights.lights.size());
  frame.spheres = uint32_t(live_.world().spheres.size());
  std::vector<std::vector<w_float4>> sums;
  for (Wavefront* one : {&wave, &fresh}) {
    for (uint32_t tile = 0; tile < 9; ++tile) one->trace(frame, {tile}, 0, 8);
    sums.push_back(one->film().read(0, 9 * kTilePixels).radiance);
  }
  const size_t bytes = sums[0].size() * sizeof(w_float4);
  EXPECT_EQ(std::memcmp(sums[0].data(), sums[1].data(), bytes), 0);
  float light = 0;
  for (const w_float4& s : sums[0]) light += s.x;
  EXPECT_GT(light, 0);
}

}  // namespace
}  // namespace wale::test
