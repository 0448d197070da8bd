// Scenes that show the same, at any accuracy, have one identity.
#include "host/scene_identity.h"

#include "host/accuracy.h"
#include "host/scene.h"
#include "tests/temporary_folder.h"

namespace wale {
namespace {

constexpr const char* kScene = R"({"wale": 1, "units": "mm", "camera": {"position": [0, 0, 60]},
 "film": {"size": [16, 16]}, "materials": {"yarn": {"type": "ply", "preset": "wool", "color": [0.5, 0.4, 0.3]}},
 "fabrics": [{"name": "cloth", "mesh": {"generator": "swatch", "width": 20, "height": 20},
  "pattern": {"builtin": "stockinette"}, "gauge": {"wales": 30}, "material": "yarn"}]})";

class SceneIdentity : public testing::Test {
 protected:
  std::string of(const std::vector<std::string>& set = {}) { return scene_identity(file_, set); }
  TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.write("scene.json", kScene);
};

TEST_F(SceneIdentity, EveryLevelOfEveryOptionShowsTheSameScene) {
  for (const AccuracyOption& option : accuracy_options())
    for (const AccuracyLevel& level : option.levels) EXPECT_EQ(of(level.overrides), of()) << option.name;
  for (const AccuracyPreset& preset : accuracy_presets()) EXPECT_EQ(of(preset.overrides()), of()) << preset.name;
}

TEST_F(SceneIdentity, SizeAndSamplesAndSeedDoNotMatter) {
  EXPECT_EQ(of({"film.size=[99,44]", "integrator.spp=7", "integrator.seed=3", "integrator.lanes=1", "film.exposure=2",
                "integrator.pool=1024"}),
            of());
}

TEST_F(SceneIdentity, LayoutOfTheFileDoesNotMatter) {
  std::string text = kScene;
  text.replace(text.find("0.5, "), 5, "0.50,// a comment\n ");
  text.replace(text.find(R"("width": 20, "height": 20)"), 25, R"("height": 2e1, "width": 20 )");
  const auto other = folder_.write("other.json", text);
  EXPECT_NO_THROW(read_scene(other));
  EXPECT_EQ(scene_identity(other, {}), of());
}

TEST_F(SceneIdentity, WhatIsSeenMatters) {
  for (const char* change : {"materials.yarn.color=[0.5,0.4,0.31]", "camera.position=[0,1,60]",
                             "fabrics.cloth.gauge={\"wales\":31}", "fabrics.0.mesh.width=21", "units=cm"})
    EXPECT_NE(of({change}), of()) << change;
}

}  // namespace
}  // namespace wale
