// From a chart to a tile: what is judged, counted and told on the way.
#include "geom/chart/knit_tile.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "geom/chart/knit_once.h"

namespace wale {
namespace {

StitchChart repeated(int wales, int rows) {
  std::string text;
  for (int r = 0; r < rows; ++r) text += fmt::format("k{}\n", wales);
  return parse_chart(text, "test.chart");
}

// In yarn diameters; from one start, so that the stitches of large repeats do not buckle.
KnitSettings settings_of(double loop_diameters) {
  KnitSettings out;
  out.loop_length = loop_diameters * out.yarn_thickness;
  out.starts = 1;
  return out;
}

// Blocking pulls at every row and every wale; how many of them a tile holds says nothing about its yarn.
TEST(KnitTile, JamsAreJudgedAlikeInRepeatsOfAnySize) {
  KnitSettings settings = settings_of(13);
  settings.blocking = 10;
  const KnittedTile one = knit_tile(repeated(1, 1), settings), many = knit_tile(repeated(4, 4), settings);
  ASSERT_TRUE(one.relaxed.converged && many.relaxed.converged);
  EXPECT_GT(one.relaxed.strain, 0.005);
  EXPECT_NEAR(many.relaxed.strain, one.relaxed.strain, 0.05 * one.relaxed.strain);
  // 3.4 to 3.6 % where 3.33 % are allowed: four times the pull on the side would have allowed 4.3 %.
  settings.loop_length = 12.52 * settings.yarn_thickness;
  EXPECT_EQ(knit_tile(repeated(1, 1), settings).relaxed.end, RelaxEnd::jammed);
  EXPECT_EQ(knit_tile(repeated(4, 4), settings).relaxed.end, RelaxEnd::jammed);
}

// The segments of the first pass are twice as long and stretch by 3.3 % here, those of the tile by half of it.
TEST(KnitTile, JamsAreJudgedOnTheTileThatIsKept) {
  KnitSettings settings = settings_of(12.8);
  const KnittedTile free = knit_tile(repeated(1, 1), settings);
  EXPECT_TRUE(free.relaxed.converged);
  EXPECT_LT(free.relaxed.strain, 0.02);
  settings = settings_of(13.2);
  settings.period = dvec2(4.3, 2) * settings.yarn_thickness;
  EXPECT_LT(knit_tile(repeated(1, 1), settings).relaxed.strain, 0.025);
  EXPECT_TRUE(knit_tile(repeated(1, 1), settings).relaxed.converged);
  settings.period = dvec2(4.5, 2) * settings.yarn_thickness;
  const KnittedTile wide = knit_tile(repeated(1, 1), settings);
  EXPECT_EQ(wide.relaxed.end, RelaxEnd::jammed);
  EXPECT_NEAR(wide.relaxed.strain, 0.032, 0.001);
}

TEST(KnitTile, StepsAreThoseOfBothPassesTogether) {
  KnitSettings settings = settings_of(13.2);
  const StitchChart chart = parse_chart("kp\n", "test.chart");
  const int needed = knit_tile(chart, settings).relaxed.steps;
  for (const int allowed : {needed - 1, needed - 10}) {
    settings.max_steps = allowed;
    const Relaxed reached = knit_tile(chart, settings).relaxed;
    EXPECT_EQ(reached.end, RelaxEnd::steps) << allowed;
    EXPECT_EQ(reached.steps, allowed);
  }
}

TEST(KnitTile, ProgressGoesOnInTheFinerPass) {
  KnitSettings settings = settings_of(15);
  settings.starts = 2;
  std::vector<double> shares;
  ASSERT_TRUE(knit_tile(parse_chart("kp\npk\n", "test.chart"), settings, [&](double share) {
                shares.push_back(share);
                return true;
              }).relaxed.converged);
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_LT(shares.front(), 0.1);
  EXPECT_GT(shares.back(), 0.9);
  EXPECT_LE(shares.back(), 1);
  EXPECT_LE(std::count(shares.begin(), shares.end(), 1.0), 1) << "what is not done is not told";
}

// A table of strains that may take an hour was cut off after the ten minutes of a relaxation of which nothing is said.
TEST(KnitTile, TheTableOfStrainsHasAllOfTheTime) {
  KnitSettings settings;
  const auto now = std::chrono::steady_clock::now();
  for (const double seconds : {20.0, 3600.0}) {
    settings.max_seconds = seconds;
    const auto until =
        now + std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(seconds));
    EXPECT_EQ(end_of(strain_settings(settings, until)), until) << seconds;
  }
}

TEST(KnitTile, AGaugeIsReachedOrThereIsNone) {
  KnitSettings settings;
  settings.wales = 200;  // per metre
  EXPECT_EQ(knit_tile(repeated(1, 1), settings).gauge_end, GaugeEnd::reached);
  settings.wales = 1500;
  EXPECT_EQ(knit_tile(repeated(1, 1), settings).gauge_end, GaugeEnd::none);
}

}  // namespace
}  // namespace wale
