// The table of accuracy options: every level can be set on every scene and is recognised; presets name one of each.
#include "host/accuracy.h"

#include <gtest/gtest.h>

#include <set>

#include "geom/error.h"
#include "host/scene.h"

namespace wale {
namespace {

constexpr const char* kTwoFabrics = R"({"wale": 1, "fabrics": [
  {"name": "a", "mesh": {"generator": "swatch"}, "pattern": {"builtin": "stockinette"}, "uv_metres": true},
  {"name": "b", "mesh": {"generator": "swatch"}, "pattern": {"builtin": "stockinette"}, "uv_metres": true}]})";

Scene with(const std::vector<std::string>& overrides) { return parse_scene(kTwoFabrics, "test.json", overrides); }

TEST(Accuracy, ASceneStandsAtTheLevelThatItWasSetTo) {
  for (const AccuracyOption& option : accuracy_options()) {
    EXPECT_GE(option.levels.size(), 2u) << option.name;
    std::set<std::string> names;
    for (const AccuracyLevel& level : option.levels) {
      EXPECT_EQ(option.at(with(level.overrides)), level.name) << option.name;
      EXPECT_TRUE(names.insert(level.name).second) << option.name;
    }
  }
}

TEST(Accuracy, APlainSceneStandsAtTheFinalPreset) {
  const Scene plain = with({});
  const AccuracyPreset& preset = accuracy_preset("final");
  for (const auto& [option, level] : preset.levels) EXPECT_EQ(accuracy_option(option).at(plain), level) << option;
}

// But of how a fabric is held, and of whether its tile has a table of strains, which they leave to the scene.
TEST(Accuracy, PresetsNameOneLevelOfEveryOption) {
  for (const AccuracyPreset& preset : accuracy_presets()) {
    const Scene scene = with(preset.overrides());
    size_t i = 0;
    for (const AccuracyOption& option : accuracy_options()) {
      if (option.name == "warp" || option.name == "strain") continue;
      ASSERT_LT(i, preset.levels.size()) << preset.name;
      const auto& [name, level] = preset.levels[i++];
      EXPECT_EQ(name, option.name) << preset.name;
      ASSERT_NE(option.level(level), nullptr) << preset.name << " " << option.name;
      EXPECT_EQ(option.at(scene), level) << preset.name << " " << option.name;
    }
    EXPECT_EQ(i, preset.levels.size()) << preset.name;
  }
}

TEST(Accuracy, PresetsKeepTheLatticeOfAFabric) {
  for (const AccuracyPreset& preset : accuracy_presets()) {
    std::vector<std::string> set = preset.overrides();
    set.insert(set.begin(), {"fabrics.*.storage=procedural", "fabrics.*.lattice=4"});
    EXPECT_EQ(accuracy_option("warp").at(with(set)), "4") << preset.name;
  }
}

TEST(Accuracy, PresetsKeepTheStrainOfAFabric) {
  for (const AccuracyPreset& preset : accuracy_presets()) {
    std::vector<std::string> set = preset.overrides();
    EXPECT_EQ(accuracy_option("strain").at(with(set)), "affine") << preset.name;
    set.insert(set.begin(), "fabrics.*.strain=relaxed");
    EXPECT_EQ(accuracy_option("strain").at(with(set)), "relaxed") << preset.name;
  }
}

TEST(Accuracy, FabricsThatDifferAreMixed) {
  EXPECT_EQ(accuracy_option("detail").at(with({"fabrics.b.detail=none"})), "mixed");
  EXPECT_EQ(accuracy_option("curves").at(with({"fabrics.*.tolerance=0.07"})), "0.07");
  EXPECT_EQ(accuracy_option("warp").at(with({"fabrics.*.storage=procedural"})), "1");
}

TEST(Accuracy, WrongNamesAreRefusedWithTheRightOnes) {
  try {
    accuracy_preset("drafft");
    FAIL();
  } catch (const Error& e) {
    EXPECT_STREQ(e.what(), "--preset drafft: no such preset; valid: draft, paper, final, reference");
  }
  EXPECT_THROW(accuracy_option("curve"), Error);
}

TEST(Accuracy, StarsStandForListsOnly) {
  EXPECT_EQ(with({"fabrics.*.tolerance=0.2"}).fabrics.at(1).spec.tolerance, 0.2);
  EXPECT_THROW(with({"film.*=1"}), Error);
  EXPECT_THROW(with({"fabric.*.tolerance=0.1"}), Error);
  EXPECT_NO_THROW(with({"lights.*.intensity=2"}));  // a list that is not there has no element to change
}

}  // namespace
}  // namespace wale
