// The levels that `wale cost` compares follow the table of accuracy options.
#include <algorithm>

#include "host/accuracy.h"
#include "host/cost/levels.h"
#include "tests/temporary_folder.h"

namespace wale::cost {
namespace {

class CostLevels : public testing::Test {
 protected:
  Levels of(const std::string& mesh = R"({"generator": "swatch", "width": 20, "height": 20})",
            const std::string& wanted = "", const std::vector<std::string>& set = {}, PictureSize size = {}) {
    const std::string fabrics = mesh.empty()
                                    ? ""
                                    : R"(, "fabrics": [{"name": "cloth", "mesh": )" + mesh +
                                          R"(, "pattern": {"builtin": "stockinette"}, "gauge": {"wales": 30}}])";
    const auto file = folder_.write(
        "scene.json", R"({"wale": 1, "units": "mm", "camera": {"position": [0, 0, 60]}, "film": {"size": [512, 256]})" +
                          fabrics + "}");
    return collect_levels(file, set, wanted_options(wanted), size);
  }
  TemporaryFolder folder_;
};

TEST_F(CostLevels, EveryLevelOfTheTableHasItsRow) {
  const Levels levels = of();
  size_t row = 0;
  const auto expect_row = [&](const std::string& option, const std::string& level) {
    ASSERT_LT(row, levels.rows.size());
    EXPECT_EQ(levels.rows[row].option, option);
    EXPECT_EQ(levels.rows[row].level, level);
    const std::optional<size_t> unit = levels.rows[row].unit;
    EXPECT_TRUE(unit ? *unit < levels.units.size() : !levels.rows[row].skipped.empty()) << option << " " << level;
    ++row;
  };
  for (const AccuracyOption& option : accuracy_options())
    for (const AccuracyLevel& level : option.levels) {
      expect_row(option.name, level.name);
      if (const auto unit = levels.rows[row - 1].unit) {
        EXPECT_EQ(option.at(levels.units[*unit].scene), level.name);
      }
    }
  for (const AccuracyPreset& preset : accuracy_presets()) expect_row("preset", preset.name);
  EXPECT_EQ(row, levels.rows.size());
}

TEST_F(CostLevels, TheReferenceIsThePresetOfThatName) {
  const Levels levels = of();
  const Level& last = levels.rows.back();
  EXPECT_EQ(last.level, "reference");
  EXPECT_EQ(last.unit, levels.reference);
}

// What the scene has anyway is not rendered again, whichever option it belongs to.
TEST_F(CostLevels, TheSceneItselfIsOneUnit) {
  const Levels levels = of();
  std::vector<std::string> own;
  for (const Level& row : levels.rows)
    if (row.own) own.push_back(row.option);
  EXPECT_EQ(own.size(), accuracy_options().size() + 1);  // and the preset "final"
  EXPECT_EQ(own.back(), "preset");
  const auto shared = std::count_if(levels.rows.begin(), levels.rows.end(), [](const auto& r) { return r.unit == 0u; });
  EXPECT_EQ(size_t(shared), own.size());
}

// As explicit fibres do: the preset keeps maps.
TEST_F(CostLevels, LevelsPastThePresetsLieBeyondTheReference) {
  const auto place = [](const AccuracyOption& option, const std::string& level) {
    return option.level(level) - option.levels.data();
  };
  int beyond = 0;
  for (const Level& row : of().rows) {
    bool expected = false;
    for (const auto& [option, level] : accuracy_preset("reference").levels)
      if (option == row.option)
        expected = place(accuracy_option(option), row.level) > place(accuracy_option(option), level);
    // Of loops the reference has the scene's, which are affine here.
    if (row.option == "strain") expected = row.level == "relaxed";
    EXPECT_EQ(row.beyond, expected) << row.option << " " << row.level;
    beyond += row.beyond;
  }
  EXPECT_GT(beyond, 0);
}

// Options that programs and launches alone know of share the cloth on the device.
TEST_F(CostLevels, GeometryIsSharedWhereItIsTheSame) {
  const Levels levels = of("{\"generator\": \"swatch\", \"width\": 20, \"height\": 20}", "depth,curves");
  for (const Level& row : levels.rows) {
    const Unit& unit = levels.units[*row.unit];
    EXPECT_EQ(unit.geometry == levels.units[0].geometry, row.own || row.option == "depth") << row.level;
  }
}

TEST_F(CostLevels, ALatticeThatDoesNotFitIsARowWithTheReason) {
  const Levels levels =
      of("{\"generator\": \"swatch\", \"width\": 20, \"height\": 20}", "warp", {"integrator.local_stage=cell"});
  ASSERT_EQ(levels.rows.size(), accuracy_option("warp").levels.size());
  for (const Level& row : levels.rows) EXPECT_TRUE(row.unit.has_value() || !row.skipped.empty());
}

TEST_F(CostLevels, ASceneWithoutClothHasNoRowsOfCloth) {
  const Levels levels = of("");
  for (const Level& row : levels.rows) {
    for (const char* cloth : {"curves", "detail", "warp", "joints", "normals", "vertices", "ply_lobes", "ply_shadows"})
      EXPECT_NE(row.option, cloth);
  }
  EXPECT_GE(levels.rows.size(), 4u);
  EXPECT_EQ(user_message([&] { of("", "joints,curves"); }), "--options curves, joints: the scene has no fabric");
}

// A fabric held procedurally has no level "mesh", and the reference does not coarsen its lattice.
TEST_F(CostLevels, TheReferenceOfAProceduralFabricHasTheFinestLattice) {
  const std::string square = "{\"generator\": \"swatch\", \"width\": 20, \"height\": 20}";
  const auto at_reference = [&](const std::vector<std::string>& set) {
    const Levels levels = of(square, "warp", set);
    return accuracy_option("warp").at(levels.units[levels.reference].scene);
  };
  EXPECT_EQ(at_reference({"fabrics.*.storage=procedural"}), "4");
  EXPECT_EQ(at_reference({"fabrics.*.storage=procedural", "fabrics.*.lattice=8"}), "8");
  EXPECT_EQ(at_reference({"fabrics.*.lattice=2"}), "mesh");
  const Levels levels = of(square, "warp", {"fabrics.*.storage=procedural"});
  EXPECT_EQ(levels.rows.back().level, "mesh");
  EXPECT_FALSE(levels.rows.back().unit);
}

TEST_F(CostLevels, PicturesAreSmallUnlessASizeIsGiven) {
  EXPECT_EQ(of().units[0].scene.film.width, 128);
  EXPECT_EQ(of().units[0].scene.film.height, 64);
  EXPECT_EQ(of("{\"generator\": \"swatch\"}", "depth", {}, {300, 200}).units[1].scene.film.width, 300);
}

TEST_F(CostLevels, WantedOptions) {
  const WantedOptions some = wanted_options("depth,presets");
  EXPECT_EQ(some.options, std::vector<std::string>{"depth"});
  EXPECT_TRUE(some.presets);
  EXPECT_FALSE(wanted_options("depth").presets);
  EXPECT_EQ(wanted_options("").options.size(), accuracy_options().size());
  EXPECT_EQ(user_message([] { wanted_options("depht"); }), "--options depht: no such option; did you mean \"depth\"?");
  EXPECT_EQ(user_message([] { wanted_options("depth,depth"); }), "--options depth: named twice");
  EXPECT_NE(user_message([] { wanted_options("depth,"); }).find("--options : no such option; valid:"),
            std::string::npos);
}

}  // namespace
}  // namespace wale::cost
