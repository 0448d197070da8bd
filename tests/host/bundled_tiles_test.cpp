// The tiles of scenes/patterns: found by name, made by the charts beside them.
#include "host/bundled_tiles.h"

#include <gtest/gtest.h>

#include "geom/chart/knit_tile.h"
#include "geom/error.h"
#include "geom/stitch.h"
#include "host/world.h"
#include "tests/tolerances.h"

namespace wale {
namespace {

const std::filesystem::path kFolder = std::filesystem::path(WALE_SOURCE_DIR) / "scenes/patterns";

Pattern bundled(const std::string& name) {
  PatternSource source;
  source.builtin = name;
  return load_pattern(source);
}

TEST(BundledTiles, EveryChartHasItsTile) {
  const auto names = bundled_tiles();
  EXPECT_EQ(names.front(), "stockinette");
  size_t charts = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kFolder)) {
    if (entry.path().extension() != ".chart") continue;
    ++charts;
    const std::string name = entry.path().stem();
    ASSERT_NE(std::find(names.begin(), names.end(), name), names.end()) << name << ": run scenes/patterns/make.sh";
    const Pattern tile = bundled(name);
    const StitchChart chart = read_chart(entry.path());
    EXPECT_EQ(tile.name, chart.name);
    EXPECT_EQ(tile.chart, chart_lines(chart)) << name << ": run scenes/patterns/make.sh";
    EXPECT_EQ(tile.stitches, ivec2(chart.wales(), int(chart.rows.size()))) << name;
    EXPECT_LT(match_partners(tile).worst_distance, 1e-3 * tile.yarn_radius) << name;
  }
  EXPECT_EQ(charts + 1, names.size());
  EXPECT_GE(charts, 16u);
}

// To the bytes on the machine that made them; elsewhere rounding may differ.
TEST(BundledTiles, ChartsGiveTheTiles) {
  for (const char* name : {"stockinette_relaxed", "garter", "rib_1x1"}) {
    const Pattern tile = bundled(name);
    const KnittedTile again = knit_tile(read_chart(kFolder / (std::string(name) + ".chart")), {});
    ASSERT_TRUE(again.relaxed.converged) << name;
    EXPECT_NEAR(again.pattern.period.x, tile.period.x, tolerance::kRelaxedAgain * tile.yarn_radius) << name;
    EXPECT_NEAR(again.pattern.period.y, tile.period.y, tolerance::kRelaxedAgain * tile.yarn_radius) << name;
    ASSERT_EQ(again.pattern.curves.size(), tile.curves.size());
    for (size_t c = 0; c < tile.curves.size(); ++c) {
      ASSERT_EQ(again.pattern.curves[c].points.size(), tile.curves[c].points.size());
      for (size_t i = 0; i < tile.curves[c].points.size(); ++i)
        EXPECT_LT(glm::distance(again.pattern.curves[c].points[i], tile.curves[c].points[i]),
                  tolerance::kRelaxedAgain * tile.yarn_radius)
            << name;
    }
  }
}

TEST(BundledTiles, NamesAreKeysOfTheScene) {
  const Scene scene = parse_scene(
      R"({"wale": 1, "fabrics": [{"mesh": {"generator": "swatch"}, "pattern": {"builtin": "rib_2x2"}, "uv_metres": true}]})",
      "s.json");
  EXPECT_EQ(load_pattern(scene.fabrics[0].pattern).stitches, ivec2(4, 1));
  EXPECT_THROW(parse_scene(R"({"wale": 1, "fabrics": [{"mesh": {"generator": "swatch"}, "pattern": {"builtin": "rib"},
                             "uv_metres": true}]})",
                           "s.json"),
               Error);
}

}  // namespace
}  // namespace wale
