// The tiles of scenes/patterns: found by name, made by the charts beside them.
#include "host/bundled_tiles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "geom/chart/knit_tile.h"
#include "geom/error.h"
#include "geom/stitch.h"
#include "host/world.h"
#include "tests/bundled_settings.h"
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
void expect_same_tile(const std::string& name) {
  const Pattern tile = bundled(name);
  const std::clock_t start = std::clock();
  const KnittedTile again = knit_tile(read_chart(kFolder / (name + ".chart")), test::bundled_settings(tile));
  std::printf(
      "  %-20s %6.1f s of processors, force %.1e, on the period %.1e, closest %.3f D, period %.3f x %.3f mm, loop %.1f "
      "mm\n",
      name.c_str(), double(std::clock() - start) / CLOCKS_PER_SEC, again.relaxed.force, again.relaxed.period_force,
      again.relaxed.closest, 1e3 * again.pattern.period.x, 1e3 * again.pattern.period.y, 1e3 * again.loop_length);
  std::fflush(stdout);
  ASSERT_TRUE(again.relaxed.converged) << name;
  EXPECT_NEAR(again.pattern.period.x, tile.period.x, tolerance::kRelaxedAgain * tile.yarn_radius) << name;
  EXPECT_NEAR(again.pattern.period.y, tile.period.y, tolerance::kRelaxedAgain * tile.yarn_radius) << name;
  const auto compare = [&](const std::vector<dvec3>& a, const std::vector<dvec3>& b) {
    ASSERT_EQ(a.size(), b.size()) << name;
    double farthest = 0;
    for (size_t i = 0; i < a.size(); ++i) farthest = std::max(farthest, glm::distance(a[i], b[i]));
    EXPECT_LT(farthest, tolerance::kRelaxedAgain * tile.yarn_radius) << name;
  };
  ASSERT_EQ(again.pattern.curves.size(), tile.curves.size());
  for (size_t c = 0; c < tile.curves.size(); ++c) compare(again.pattern.curves[c].points, tile.curves[c].points);
  ASSERT_EQ(again.pattern.strains.offsets.size(), tile.strains.offsets.size());
  for (size_t s = 0; s < tile.strains.offsets.size(); ++s)
    compare(again.pattern.strains.offsets[s], tile.strains.offsets[s]);
}

TEST(BundledTiles, ChartsGiveTheTiles) {
  for (const char* name : test::kQuickTiles) expect_same_tile(name);
}

TEST(BundledTiles, ChartsGiveTheTilesThatTakeLong) {
  if (!std::getenv("WALE_LONG_TESTS")) GTEST_SKIP() << "takes minutes; set WALE_LONG_TESTS=1";
  for (const std::string& name : bundled_tiles())
    if (name != "stockinette" &&
        std::find(std::begin(test::kQuickTiles), std::end(test::kQuickTiles), name) == std::end(test::kQuickTiles))
      expect_same_tile(name);
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
