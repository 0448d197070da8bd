#include <ctime>

#include "tests/geom/tile_fixtures.h"
#include "tests/tolerances.h"

namespace wale {
namespace {

using namespace test;

Pattern as_bspline(Pattern pattern) {
  pattern.kind = CurveKind::bspline;
  return pattern;
}

void expect_same_topology(const Pattern& a, const Pattern& b) {
  ASSERT_EQ(a.curves.size(), b.curves.size());
  const PartnerMap ma = match_partners(a), mb = match_partners(b);
  const std::vector<YarnChain> ya = tile_yarns(a, ma), yb = tile_yarns(b, mb);
  ASSERT_EQ(ya.size(), yb.size());
  for (size_t i = 0; i < ya.size(); ++i) {
    EXPECT_EQ(ya[i].shift, yb[i].shift);
    ASSERT_EQ(ya[i].links.size(), yb[i].links.size());
    for (size_t j = 0; j < ya[i].links.size(); ++j) {
      EXPECT_EQ(ya[i].links[j].curve, yb[i].links[j].curve);
      EXPECT_EQ(ya[i].links[j].instance, yb[i].links[j].instance);
      EXPECT_EQ(ya[i].links[j].reversed, yb[i].links[j].reversed);
    }
  }
}

/// A tile whose yarns cross both borders, so that both periods can be told.
Pattern crossing_tile(uint64_t seed) {
  std::mt19937_64 random(seed);
  return as_bspline(recut(two_row_tile(), {0.0003, 0.0011}, &random));
}

TEST(LeafReader, RoundTripRecoversPeriodsAndTopology) {
  ScratchFolder folder;
  for (uint64_t seed = 0; seed < 20; ++seed) {
    const Pattern tile = crossing_tile(seed);
    const auto file = folder / fmt::format("tile_{:.17g}.txt", tile.yarn_radius / 1e-3);
    write_pattern_leaf(tile, file);
    const Pattern back = read_pattern(file);
    EXPECT_EQ(back.kind, CurveKind::bspline);
    EXPECT_NEAR(back.period.x / tile.period.x, 1, 1e-9);
    EXPECT_NEAR(back.period.y / tile.period.y, 1, 1e-9);
    EXPECT_NEAR(back.yarn_radius / tile.yarn_radius, 1, 1e-12);
    EXPECT_EQ(back.stitches, ivec2(1, 2));
    expect_same_topology(tile, back);
  }
}

TEST(LeafReader, JitteredEndsAreAveraged) {
  ScratchFolder folder;
  for (uint64_t seed = 0; seed < 20; ++seed) {
    const Pattern tile = crossing_tile(seed);
    Pattern jittered = tile;
    std::mt19937_64 random(seed + 100);
    const double most = 0.05 * tile.yarn_radius;
    std::uniform_real_distribution<double> jitter(-most, most);
    for (PatternCurve& curve : jittered.curves)
      curve.points.back() += dvec3(jitter(random), jitter(random), jitter(random));
    const auto file = folder / fmt::format("tile_{:.17g}.txt", tile.yarn_radius / 1e-3);
    write_pattern_leaf(jittered, file);
    const Pattern back = read_pattern(file);
    EXPECT_NEAR(back.period.x, tile.period.x, 2 * most);
    EXPECT_NEAR(back.period.y, tile.period.y, 2 * most);
    expect_same_topology(tile, back);
    EXPECT_LT(match_partners(back).worst_distance, 1e-15);
  }
}

TEST(LeafReader, UnitScalesAndZIsCentred) {
  ScratchFolder folder;
  Pattern tile = crossing_tile(1);
  for (PatternCurve& curve : tile.curves)
    for (dvec3& p : curve.points) p.z += 0.01;
  write_pattern_leaf(tile, folder / "tile_0.02.txt", 1e-2);
  PatternHints hints;
  hints.unit = 1e-2;
  const Pattern back = read_pattern(folder / "tile_0.02.txt", hints);
  EXPECT_NEAR(back.yarn_radius, 0.0002, 1e-15);
  EXPECT_NEAR(back.period.x, tile.period.x, 1e-12);
  double lo = 1, hi = -1;
  for (const PatternCurve& curve : back.curves)
    for (const dvec3& p : curve.points) lo = std::min(lo, p.z), hi = std::max(hi, p.z);
  EXPECT_NEAR(lo + hi, 0, 1e-12);
  EXPECT_GT(hi - lo, 1e-4);
}

TEST(LeafReader, RepeatedCurvesAreDropped) {
  ScratchFolder folder;
  const Pattern tile = crossing_tile(2);
  Pattern doubled = tile;
  doubled.curves.push_back(tile.curves[1]);  // in place
  doubled.curves.push_back(tile.curves[0]);  // backwards
  std::reverse(doubled.curves.back().points.begin(), doubled.curves.back().points.end());
  write_pattern_leaf(doubled, folder / "tile_0.24.txt");
  expect_same_topology(tile, read_pattern(folder / "tile_0.24.txt"));
}

TEST(LeafReader, OverlapByTwoControlPoints) {
  ScratchFolder folder;
  const Pattern tile = crossing_tile(3);
  const PartnerMap map = match_partners(tile);
  Pattern longer = tile;
  for (const int c : {0, 1}) {  // the last end goes on to the second point of the curve that follows
    const Partner& on = map.of[c][1];
    const auto& next = tile.curves[on.to.curve].points;
    const dvec3 second = on.to.end == 0 ? next[1] : next[next.size() - 2];
    longer.curves[c].points.push_back(second + dvec3(on.shift.x * tile.period.x, on.shift.y * tile.period.y, 0));
  }
  write_pattern_leaf(longer, folder / "tile_0.24.txt");
  const Pattern back = read_pattern(folder / "tile_0.24.txt");
  expect_same_topology(tile, back);
  size_t before = 0, after = 0;
  for (const PatternCurve& curve : tile.curves) before += curve.points.size();
  for (const PatternCurve& curve : back.curves) after += curve.points.size();
  EXPECT_EQ(before, after);
  EXPECT_NEAR(back.period.y / tile.period.y, 1, 1e-9);
}

void expect_refused(const std::string& text, const std::vector<std::string>& texts,
                    const std::string& name = "tile_0.5.txt") {
  ScratchFolder folder;
  const auto file = folder.write(name, text);
  std::vector<std::string> all = texts;
  all.push_back(name);
  expect_user_error([&] { read_pattern(file); }, all);
}

const std::string kBlock = "\n3\n0 0 0\n1 0 0\n2 0 0\n";

TEST(LeafReader, RadiusMissingInName) {
  expect_refused("Num Yarns: 1\n" + kBlock, {"NAME_RADIUS.txt"}, "tile.txt");
  expect_refused("Num Yarns: 1\n" + kBlock, {"NAME_RADIUS.txt"}, "tile_-2.txt");
}
TEST(LeafReader, BadHeader) { expect_refused("Yarns 3\n", {":1:", "Num Yarns: n"}); }
TEST(LeafReader, NoYarns) { expect_refused("Num Yarns: 0\n", {":1:", "at least one"}); }
TEST(LeafReader, Empty) { expect_refused("", {"Num Yarns: n"}); }
TEST(LeafReader, Truncated) { expect_refused("Num Yarns: 1\n3\n0 0 0\n1 0 0\n", {"after 2 of 3 points", "cut off"}); }
TEST(LeafReader, CountMismatch) { expect_refused("Num Yarns: 2\n" + kBlock, {"says 2 yarns, but 1"}); }
TEST(LeafReader, CurveOfOnePoint) { expect_refused("Num Yarns: 1\n1\n0 0 0\n", {":2:", "curve of 1 points"}); }
TEST(LeafReader, NaN) { expect_refused("Num Yarns: 1\n2\n0 nan 0\n1 0 0\n", {":3:", "'nan'"}); }
TEST(LeafReader, TwoNumbersInARow) { expect_refused("Num Yarns: 1\n2\n0 0\n1 0 0\n", {":3:", "x y z"}); }
TEST(LeafReader, PeriodUnknownWithoutCrossing) {
  expect_refused("Num Yarns: 1\n" + kBlock, {"y period", "give the period"});
}
TEST(LeafReader, GivenPeriodIsUsed) {
  ScratchFolder folder;
  PatternHints hints;
  hints.period = {0, 0.003};
  const Pattern tile = read_pattern(folder.write("tile_0.5.txt", "Num Yarns: 1\n" + kBlock), hints);
  EXPECT_NEAR(tile.period.x, 0.002, 1e-15);
  EXPECT_EQ(tile.period.y, 0.003);
}
// Every pair of ends votes for a period: a file of 64 KiB must not take a minute, nor a gigabyte.
TEST(LeafReader, ThousandsOfCurvesAreRefusedAtOnce) {
  std::string text = "Num Yarns: 4600\n";
  for (int i = 0; i < 4600; ++i) text += fmt::format("2\n{} {} 0\n1 0 0\n", i % 97, i / 97);
  expect_refused(text, {"curve ends", "at most 512", "give the period"});
}
TEST(LeafReader, ThousandsOfEndsInOnePlaceAreRefused) {
  std::string text = "Num Yarns: 2000\n";
  for (int i = 0; i < 2000; ++i) text += fmt::format("3\n0 0 0\n{} 1 0\n1 0 0\n", i);
  ScratchFolder folder;
  PatternHints hints;
  hints.period = {0.001, 0.001};
  const auto file = folder.write("tile_0.5.txt", text);
  expect_user_error([&] { read_pattern(file, hints); }, {"more than 64 ends", "yarn radius"});
}
// A file of 12 KiB where no period fits: each of 576 pairs of periods was tried to its end, for seconds.
TEST(LeafReader, EndsWithoutOrderAreRefusedSoon) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> place(0, 1);
  std::string text = "Num Yarns: 256\n";
  for (int i = 0; i < 256; ++i) {
    text += "3\n";
    for (int k = 0; k < 3; ++k) {
      const double x = place(random), y = place(random);
      text += fmt::format("{:.4f} {:.4f} 0\n", x, y);
    }
  }
  const std::clock_t start = std::clock();
  expect_refused(text, {"cannot be recovered", "the likeliest", "of 512 curve ends"}, "tile_0.1.txt");
  EXPECT_LE(double(std::clock() - start) / CLOCKS_PER_SEC, tolerance::kReaderSeconds);
}
TEST(LeafReader, WriterRefusesRings) {
  ScratchFolder folder;
  expect_user_error([&] { write_pattern_leaf(diagonal_and_ring(), folder / "t_1.txt"); }, {"closed", ".json"});
}

}  // namespace
}  // namespace wale
