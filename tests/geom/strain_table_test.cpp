// Tables of strains: looked up, written and read, refused with one line.
#include "tests/geom/strained_fixtures.h"

namespace wale {
namespace {

using namespace test;

TEST(StrainTable, IsInterpolatedBilinearlyAndHeldAtItsBorders) {
  StrainTable table;
  table.course = {-0.2, 0, 1};
  table.wale = {0, 0.5};
  for (const double b : table.wale)
    for (const double a : table.course) table.offsets.push_back({dvec3(a, b, a * b)});
  const auto at = [&](dvec2 strain) {
    dvec3 sum(0);
    const StrainWeights weights = strain_weights(table, strain);
    for (int i = 0; i < 4; ++i) sum += weights.weight[i] * table.offsets[weights.node[i]][0];
    return sum;
  };
  for (const dvec2 s : {dvec2(-0.2, 0), dvec2(-0.1, 0.2), dvec2(0.3, 0.4), dvec2(1, 0.5), dvec2(0, 0.25)}) {
    EXPECT_LT(glm::length(at(s) - dvec3(s, s.x * s.y)), 1e-15);
    EXPECT_FALSE(strain_weights(table, s).clamped);
  }
  EXPECT_EQ(at({0, 0}), dvec3(0));
  EXPECT_LT(glm::length(at({2, 0.25}) - dvec3(1, 0.25, 0.25)), 1e-15);
  EXPECT_LT(glm::length(at({-1, -1}) - dvec3(-0.2, 0, 0)), 1e-15);
  for (const dvec2 s : {dvec2(1.01, 0.1), dvec2(-0.21, 0.1), dvec2(0, 0.51), dvec2(0, -0.01)})
    EXPECT_TRUE(strain_weights(table, s).clamped);
}

TEST(StrainTable, OneStrainIsATable) {
  StrainTable table;
  table.course = table.wale = {0};
  table.offsets = {{dvec3(1, 2, 3)}};
  EXPECT_EQ(fault_of(table, 1), "");
  const StrainWeights weights = strain_weights(table, {0.3, 0});
  EXPECT_EQ(weights.node[0], 0u);
  EXPECT_EQ(weights.weight[0], 1);
  EXPECT_TRUE(weights.clamped);
}

TEST(StrainTable, RoundTripIsExact) {
  ScratchFolder folder;
  const Pattern tile = straining_tile(0.000317);
  write_pattern_json(tile, folder / "t.json");
  const Pattern back = read_pattern(folder / "t.json");
  EXPECT_EQ(back.strains.course, tile.strains.course);
  EXPECT_EQ(back.strains.wale, tile.strains.wale);
  EXPECT_EQ(back.strains.offsets, tile.strains.offsets);
}

TEST(StrainTable, ARingThatRepeatsItsFirstPointLosesItsOffsetToo) {
  ScratchFolder folder;
  Pattern tile = diagonal_and_ring();
  std::swap(tile.curves[0], tile.curves[1]);
  tile.curves[0].points.push_back(tile.curves[0].points.front());
  tile.strains.course = tile.strains.wale = {0};
  auto& shape = tile.strains.offsets.emplace_back();
  for (size_t i = 0; i < point_count(tile); ++i) shape.push_back(dvec3(double(i)));
  write_pattern_json(tile, folder / "t.json");
  const Pattern back = read_pattern(folder / "t.json");
  const size_t ring = back.curves[0].points.size();
  ASSERT_EQ(back.strains.offsets[0].size(), point_count(back));
  EXPECT_EQ(back.strains.offsets[0][ring - 1], dvec3(double(ring - 1)));
  EXPECT_EQ(back.strains.offsets[0][ring], dvec3(double(ring + 1)));
}

constexpr const char* kTile =
    "{\"wale_tile\": 1, \"period\": [0.002, 0.003], \"yarn_radius\": 0.0002, \"stitches\": [1, 1],\n"
    " \"curves\": [{\"points\": [[0, 0, 0], [0.001, 0.0005, 0], [0.002, 0, 0]]}],\n"
    " \"strains\": {\"course\": [0, 0.5], \"wale\": [0],\n"
    "  \"offsets\": [[[0,0,0],[0,0,0],[0,0,0]], [[0,0,0],[0,0,1e-4],[0,0,0]]]}}\n";

void expect_refused(const std::string& from, const std::string& to, const std::vector<std::string>& texts) {
  std::string text = kTile;
  const size_t at = text.find(from);
  ASSERT_NE(at, std::string::npos);
  text.replace(at, from.size(), to);
  expect_user_error([&] { parse_pattern(text, "t.json"); }, texts);
}

TEST(StrainTable, BadOnesAreRefused) {
  EXPECT_NO_THROW(parse_pattern(kTile, "t.json"));
  expect_refused("[0, 0.5]", "[0, 0]", {"t.json", "strains.course[1]", "ascend"});
  expect_refused("[0, 0.5]", "[0.5, 0]", {"t.json", "strains.course[1]", "0 after 0.5"});
  expect_refused("[0, 0.5]", "[0.1, 0.5]", {"t.json", "strains.course", "0 is not among"});
  expect_refused("\"wale\": [0]", "\"wale\": [0.1]", {"t.json", "strains.wale", "0 is not among"});
  expect_refused("[0, 0.5]", "[-1, 0]", {"t.json", "strains.course[0]", "-1"});
  expect_refused("[0, 0.5]", "[0, 1e999]", {"t.json"});
  expect_refused("[0, 0.5]", "[0, null]", {"t.json", "strains.course[1]", "number"});
  expect_refused("[0, 0.5]", "[]", {"t.json", "strains.course", "no strains"});
  expect_refused("[0, 0.5]", "[0, 0.5, 1]", {"t.json", "strains.offsets", "2 shapes for 3 x 1"});
  expect_refused("\"wale\": [0]", "\"wale\": []", {"t.json", "strains.wale", "0 is not among"});
  expect_refused("[[0,0,0],[0,0,0],[0,0,0]], ", "", {"t.json", "strains.offsets", "1 shapes for 2 x 1"});
  expect_refused("[0,0,1e-4],", "", {"t.json", "strains.offsets[1]", "2 points", "3"});
  expect_refused("[0,0,1e-4]", "[0,0]", {"t.json", "strains.offsets[1][1]", "3 numbers"});
  expect_refused("[0,0,1e-4]", "[0,NaN,0]", {"t.json:4"});
  expect_refused("\"course\"", "\"courses\"", {"t.json", "strains", "unknown key 'courses'"});
}

TEST(StrainTable, NaNIsNamedWhereverItComesFrom) {
  StrainTable table = straining_tile(0.0001).strains;
  table.offsets[4][2].y = NAN;
  EXPECT_EQ(fault_of(table, table.offsets[4].size()), "offsets[4][2]: the offset is not finite");
  table.wale[0] = NAN;
  EXPECT_EQ(fault_of(table, table.offsets[4].size()), "wale[0]: the strain is not finite");
}

}  // namespace
}  // namespace wale
