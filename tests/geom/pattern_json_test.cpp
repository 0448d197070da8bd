#include "tests/geom/tile_fixtures.h"

namespace wale {
namespace {

using namespace test;

const char* kTile =
    "{\"wale_tile\": 1, \"name\": \"row\", \"period\": [0.002, 0.003], \"yarn_radius\": 0.0002,\n"
    " \"stitches\": [1, 2], \"kind\": \"bspline\",\n"
    " \"curves\": [{\"points\": [[0, 0, 0], [0.001, 0.0005, 0], [0.002, 0, 0]], \"closed\": false}]}\n";

void expect_refused(const std::string& from, const std::string& to, const std::vector<std::string>& texts) {
  std::string text = kTile;
  const size_t at = text.find(from);
  ASSERT_NE(at, std::string::npos);
  ScratchFolder folder;
  const auto file = folder.write("t.json", text.replace(at, from.size(), to));
  expect_user_error([&] { read_pattern(file); }, texts);
}

TEST(JsonTile, Reads) {
  ScratchFolder folder;
  const Pattern tile = read_pattern(folder.write("t.json", kTile));
  EXPECT_EQ(tile.name, "row");
  EXPECT_EQ(tile.period, dvec2(0.002, 0.003));
  EXPECT_EQ(tile.stitches, ivec2(1, 2));
  EXPECT_EQ(tile.kind, CurveKind::bspline);
  EXPECT_EQ(tile.curves[0].points[1], dvec3(0.001, 0.0005, 0));
}

TEST(JsonTile, RoundTripIsExact) {
  ScratchFolder folder;
  for (const Pattern& tile : {recut(two_row_tile(), {0.0003, 0.0011}), diagonal_and_ring()}) {
    write_pattern_json(tile, folder / "t.json");
    const Pattern back = read_pattern(folder / "t.json");
    EXPECT_EQ(back.name, tile.name);
    EXPECT_EQ(back.period, tile.period);
    EXPECT_EQ(back.yarn_radius, tile.yarn_radius);
    EXPECT_EQ(back.kind, tile.kind);
    ASSERT_EQ(back.curves.size(), tile.curves.size());
    for (size_t c = 0; c < tile.curves.size(); ++c) {
      EXPECT_EQ(back.curves[c].closed, tile.curves[c].closed);
      EXPECT_EQ(back.curves[c].points, tile.curves[c].points);
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "t.json.tmp"));
  }
}

TEST(JsonTile, RingThatRepeatsItsFirstPoint) {
  ScratchFolder folder;
  Pattern tile = diagonal_and_ring();
  const size_t points = tile.curves[1].points.size();
  tile.curves[1].points.push_back(tile.curves[1].points.front());
  write_pattern_json(tile, folder / "t.json");
  EXPECT_EQ(read_pattern(folder / "t.json").curves[1].points.size(), points);
}

TEST(JsonTile, ColoursAndOriginComeBack) {
  ScratchFolder folder;
  Pattern tile = two_row_tile();
  tile.palette = {{1, 2, 255}, {16, 0, 9}};
  tile.curves[1].yarn = 1;
  tile.chart = {"kp \"\\", "pk"};
  tile.settings = {{"loop_length", 0.0132}, {"step", 0.6}};
  write_pattern_json(tile, folder / "t.json");
  const Pattern back = read_pattern(folder / "t.json");
  EXPECT_EQ(back.palette, tile.palette);
  EXPECT_EQ(back.curves[1].yarn, 1);
  EXPECT_EQ(back.chart, tile.chart);
  EXPECT_EQ(back.settings, tile.settings);
}
TEST(JsonTile, BadColours) {
  const std::string kind = "\"kind\": \"bspline\"";
  expect_refused(kind, kind + ", \"palette\": [\"red\"]", {"palette[0]", "#rrggbb"});
  expect_refused("\"closed\"", "\"yarn\": -1, \"closed\"", {"curves[0].yarn", "0 to 255"});
  expect_refused("\"kind\": \"bspline\",\n \"curves\": [{", "\"palette\": [\"#000000\"], \"curves\": [{\"yarn\": 1, ",
                 {"palette", "curve 0 is of yarn 1"});
}
TEST(JsonTile, UnwritableFolder) {
  expect_user_error([] { write_pattern_json(two_row_tile(), "/nowhere/t.json"); }, {"/nowhere/t.json", "written"});
}
TEST(JsonTile, SyntaxErrorNamesTheLine) { expect_refused("\"stitches\":", "\"stitches\"", {"t.json:2:"}); }
TEST(JsonTile, Truncated) { expect_refused("\"closed\": false}]}\n", "", {"t.json:3:", "unexpected end"}); }
TEST(JsonTile, UnknownKey) { expect_refused("stitches", "stiches", {"unknown key 'stiches'", "stitches"}); }
TEST(JsonTile, MissingKey) { expect_refused("\"yarn_radius\": 0.0002,", "", {"'yarn_radius' is missing"}); }
TEST(JsonTile, OtherVersion) { expect_refused("\"wale_tile\": 1", "\"wale_tile\": 2", {"wale_tile", "version 1"}); }
TEST(JsonTile, ZeroPeriod) { expect_refused("[0.002, 0.003]", "[0, 0.003]", {"period[0]", "positive"}); }
TEST(JsonTile, NegativeRadius) { expect_refused("0.0002,", "-0.0002,", {"yarn_radius", "positive"}); }
TEST(JsonTile, NullCoordinate) { expect_refused("0.0005", "null", {"curves[0].points[1][1]", "number"}); }
TEST(JsonTile, HugeNumber) { expect_refused("0.0005", "1e999", {"t.json"}); }
TEST(JsonTile, PointOfTwo) { expect_refused("[0, 0, 0]", "[0, 0]", {"curves[0].points[0]", "3 numbers"}); }
TEST(JsonTile, NoCurves) { expect_refused("[{\"points\"", "[] , \"name\": [{\"points\"", {"name", "text"}); }
TEST(JsonTile, EmptyCurves) {
  ScratchFolder folder;
  const auto file = folder.write("t.json", R"({"wale_tile":1,"period":[1,1],"yarn_radius":0.1,"curves":[]})");
  expect_user_error([&] { read_pattern(file); }, {"no curves"});
}
TEST(JsonTile, UnknownKind) { expect_refused("\"bspline\"", "\"bezier\"", {"'bezier'", "interpolating or bspline"}); }
TEST(JsonTile, ZeroStitches) { expect_refused("[1, 2]", "[1, 0]", {"stitches[1]", "at least 1"}); }
TEST(JsonTile, HugeStitches) { expect_refused("[1, 2]", "[1, 99999999999]", {"stitches[1]", "too large"}); }
TEST(JsonTile, KeyOfTwoLinesIsNamedInOne) { expect_refused("\"name\"", "\"na\\nme\"", {"unknown key 'na me'"}); }
TEST(JsonTile, PointsThatCoincide) {
  expect_refused("[0.001, 0.0005, 0], [0.002, 0, 0]", "[0, 0, 0]", {"curve 0", "coincide"});
}

}  // namespace
}  // namespace wale
