#include "tests/geom/tile_fixtures.h"

namespace wale {
namespace {

using namespace test;

// One yarn in x that crosses the upper border twice, and a triangle that crosses none.
const char* kTile =
    "*pattern # px py radius num_vertedges\n0.004 0.003 0.0002 7\n\n"
    "*Q # x y z theta\n-0.001 0.0005 0 0\n0.000 0.0014 0.0001 0\n0.0005 -0.0014 0.0002 0\n0.0015 0.0005 0 0\n"
    "0 0 0 0\n0.0005 0 0.0003 0\n0.0002 0.0004 0 0\n\n"
    "*E # edges\n0 1 0 0\n1 2 0 1\n2 3 0 -1\n3 0 1 0\n4 5 0 0\n5 6 0 0\n6 4 0 0\n\n*RL # rest lengths\n1\n";

std::string changed(const std::string& from, const std::string& to) {
  std::string text = kTile;
  const size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

void expect_refused(const std::string& text, const std::vector<std::string>& texts) {
  ScratchFolder folder;
  const auto file = folder.write("tile.pyp", text);
  std::vector<std::string> all = texts;
  all.push_back(file.string());
  expect_user_error([&] { read_pattern(file); }, all);
}

TEST(PypReader, CutsCyclesAtBordersAndRepeatsTheFarVertex) {
  ScratchFolder folder;
  const Pattern tile = read_pattern(folder.write("tile.pyp", kTile));
  EXPECT_EQ(tile.name, "tile");
  EXPECT_EQ(tile.period, dvec2(0.004, 0.003));
  EXPECT_EQ(tile.yarn_radius, 0.0002);
  ASSERT_EQ(tile.curves.size(), 4u);
  size_t open = 0, closed = 0, points = 0;
  for (const PatternCurve& curve : tile.curves) {
    (curve.closed ? closed : open) += 1;
    points += curve.points.size() - (curve.closed ? 0 : 1);
  }
  EXPECT_EQ(open, 3u);
  EXPECT_EQ(closed, 1u);
  EXPECT_EQ(points, 7u);
  const PartnerMap map = match_partners(tile);
  expect_involution(tile, map);
  EXPECT_LT(map.worst_distance, 1e-18);
  const std::vector<YarnChain> yarns = tile_yarns(tile, map);
  ASSERT_EQ(yarns.size(), 2u);
  EXPECT_EQ(yarns[0].shift, ivec2(1, 0));
  EXPECT_EQ(yarns[0].links.size(), 3u);
  EXPECT_EQ(tile.stitches, ivec2(1, 1));
}

TEST(PypReader, HintsOverrideTheFile) {
  ScratchFolder folder;
  PatternHints hints;
  hints.yarn_radius = 0.0003;
  hints.stitches = {2, 3};
  const Pattern tile = read_pattern(folder.write("tile.pyp", kTile), hints);
  EXPECT_EQ(tile.yarn_radius, 0.0003);
  EXPECT_EQ(tile.stitches, ivec2(2, 3));
}

TEST(PypReader, MissingFile) {
  expect_user_error([] { read_pattern("/nowhere/tile.pyp"); }, {"/nowhere/tile.pyp", "no such file"});
}
TEST(PypReader, FolderInsteadOfFile) {
  ScratchFolder folder;
  std::filesystem::create_directory(folder / "x.pyp");
  expect_user_error([&] { read_pattern(folder / "x.pyp"); }, {"is a folder"});
}
TEST(PypReader, UnknownSuffix) {
  expect_user_error([] { read_pattern("tile.obj"); }, {"'.obj'", ".pyp, .txt, .bcc, .json"});
}
TEST(PypReader, NegativeHint) {
  PatternHints hints;
  hints.yarn_radius = -1;
  expect_user_error([&] { read_pattern("tile.pyp", hints); }, {"must be positive", "-1"});
}
TEST(PypReader, NotANumberIsRefused) { expect_refused(changed("0.000 0.0014", "nan 0.0014"), {":6:", "not a finite"}); }
TEST(PypReader, WordIsRefused) { expect_refused(changed("0.000 0.0014", "zero 0.0014"), {":6:", "'zero'"}); }
TEST(PypReader, ZeroPeriod) { expect_refused(changed("0.004 0.003", "0 0.003"), {":2:", "period", "positive"}); }
TEST(PypReader, NegativePeriod) { expect_refused(changed("0.004 0.003", "0.004 -1"), {":2:", "period", "positive"}); }
TEST(PypReader, ZeroRadius) { expect_refused(changed("0.0002 7", "0 7"), {":2:", "yarn radius", "positive"}); }
TEST(PypReader, NoVertices) { expect_refused(changed("0.0002 7", "0.0002 0"), {":2:", "0 vertices"}); }
TEST(PypReader, HugeVertexCount) { expect_refused(changed("0.0002 7", "0.0002 9999999999"), {"'*Q' has 7 rows"}); }
TEST(PypReader, CountMismatch) { expect_refused(changed("0.0002 7", "0.0002 8"), {"'*Q' has 7 rows; 8"}); }
TEST(PypReader, RowTooShort) { expect_refused(changed("4 5 0 0", "4 5 0"), {":18:", "'*E' has 3 numbers; 4"}); }
TEST(PypReader, EdgeIndexOutOfRange) { expect_refused(changed("4 5 0 0", "4 7 0 0"), {":18:", "vertex 7", "0 to 6"}); }
TEST(PypReader, NegativeEdgeIndex) { expect_refused(changed("4 5 0 0", "-4 5 0 0"), {":18:", "vertex -4"}); }
TEST(PypReader, EdgeAcrossTwoPeriods) { expect_refused(changed("4 5 0 0", "4 5 2 0"), {":18:", "-1, 0 and 1"}); }
// The magnitude of the least long is no long: the check of it must not need one.
TEST(PypReader, EdgeAcrossTheLeastLong) {
  expect_refused(changed("4 5 0 0", "4 5 -9223372036854775808 0"), {":18:", "-1, 0 and 1"});
}
TEST(PypReader, BranchIsRefused) { expect_refused(changed("5 6 0 0", "4 6 0 0"), {":19:", "leaves vertex 4"}); }
TEST(PypReader, MergeIsRefused) { expect_refused(changed("5 6 0 0", "5 5 0 0"), {":19:", "enters vertex 5"}); }
TEST(PypReader, Truncated) {
  const std::string text = kTile;
  expect_refused(text.substr(0, text.find("*E")), {"'*E' is missing", "cut off"});
  expect_refused(text.substr(0, text.find("4 5 0 0")), {"'*E' has 4 rows; 7"});
}
TEST(PypReader, EmptyFile) { expect_refused("", {"'*pattern' is missing"}); }
TEST(PypReader, TextBeforeTheFirstBlock) { expect_refused("hello\n", {":1:", "'hello'"}); }

}  // namespace
}  // namespace wale
