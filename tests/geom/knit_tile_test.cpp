// From a chart to a tile: what is judged, counted and told on the way.
#include "geom/chart/knit_tile.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

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
  settings.blocking = 5;
  const KnittedTile one = knit_tile(repeated(1, 1), settings), many = knit_tile(repeated(4, 4), settings);
  ASSERT_TRUE(one.relaxed.converged && many.relaxed.converged);
  EXPECT_GT(one.relaxed.strain, 0.005);
  EXPECT_NEAR(many.relaxed.strain, one.relaxed.strain, 0.05 * one.relaxed.strain);
  // 3.3 % where 3.17 % are allowed: four times the pull on the side would have allowed 3.7 %.
  settings.loop_length = 12.8 * settings.yarn_thickness;
  EXPECT_EQ(knit_tile(repeated(1, 1), settings).relaxed.end, RelaxEnd::jammed);
  EXPECT_EQ(knit_tile(repeated(4, 4), settings).relaxed.end, RelaxEnd::jammed);
}

}  // namespace
}  // namespace wale
