// Charts as text and JSON, what they say about bad input, and the loops that they become.
#include "geom/chart/stitch_chart.h"

#include "geom/chart/loops.h"
#include "tests/geom/tile_fixtures.h"

namespace wale {
namespace {

using namespace test;
using Lines = std::vector<std::string>;

StitchChart text(const std::string& chart) { return parse_chart(chart, "c.chart"); }
StitchChart json(const std::string& chart) { return parse_chart(chart, "c.json"); }
void refused(const std::string& chart, const Lines& texts) {
  expect_user_error([&] { knit_chart(text(chart)); }, texts);
}
void json_refused(const std::string& rows, const Lines& texts) {
  expect_user_error([&] { json(R"({"wale_chart": 1, "rows": )" + rows + "}"); }, texts);
}

TEST(StitchChart, RowsAreReadFromTheLastUp) {
  const StitchChart chart = text("name: two\n# a comment\np p  # purl\nk2\n");
  EXPECT_EQ(chart.name, "two");
  ASSERT_EQ(chart.rows.size(), 2u);
  EXPECT_EQ(chart.rows[0].cells[0].stitch, Stitch::knit);
  EXPECT_EQ(chart.rows[1].cells[1].stitch, Stitch::purl);
  EXPECT_EQ(chart_lines(chart), (Lines{"pp", "kk"}));
}

TEST(StitchChart, EverySymbol) {
  const StitchChart chart = text("kpsStT c2/1f c4b o/ \\o yo ssk k2tog yo");
  EXPECT_EQ(chart.wales(), 6 + 3 + 4 + 8);
  EXPECT_EQ(chart_lines(chart), (Lines{"kpsStT c2/1f  c2/2b o/\\oo\\/o"}));
  EXPECT_TRUE(chart.rows[0].cells[6].left_in_front);
  EXPECT_EQ(chart.rows[0].cells[6].left, 2);
  EXPECT_FALSE(chart.rows[0].cells[7].left_in_front);
}

TEST(StitchChart, Decreases) {
  const StitchChart chart = text("o p2tog ssp o  o k3tog o k3togtbl oo  o cdd o\n");
  EXPECT_EQ(chart.wales(), 13);
  EXPECT_EQ(chart_lines(chart), (Lines{"o p2tog  ssp oo k3tog o k3togtbl ooo cdd o"}));
  EXPECT_EQ(chart_lines(text(chart_lines(chart)[0])), chart_lines(chart));
  refused("k4\nk2 cdd\n", {"c.chart:2:4: this decrease takes 3 loops", "of the 4"});
  refused("k p3tog\nk2\n", {"c.chart:1:7", "\"g\" is no stitch", "p2tog, ssp, k3tog, k3togtbl, sk2p, cdd, s2kp"});
  // Words, and what they are with blanks.
  EXPECT_EQ(chart_lines(text("o sk2p o o s2kp o\n")), (Lines{"o sk2p oo cdd o"}));
  EXPECT_EQ(chart_lines(text("s k2 p\nk4\n")), (Lines{"skkp", "kkkk"}));
  const Lines hint = {"sk2p is one decrease, single stitches are written with blanks: s k2 p"};
  refused("k4\nsk2p\n", {"c.chart:2:1: this row takes 3 of the 4", hint[0]});
  refused("k2\nsk2p\n", {"c.chart:2:1: this decrease takes 3 loops", hint[0]});
  refused("sk2p\nk3\n", {"c.chart:2:1: this stitch takes 1 loops", hint[0]});
  refused("k3\nssk\n", {"c.chart:2:1: this row takes 2 of the 3", "ssk is one decrease", "with blanks: s s k"});
  refused("k4\ns2kp\n", {"with blanks: s2 k p"});
}

TEST(StitchChart, YarnsOfStitches) {
  const StitchChart chart = text("yarn a: #1d3f72  # navy\nyarn c:\nk4 | a2 c a\nk4 | c\n");
  ASSERT_EQ(chart.yarns.size(), 2u);
  EXPECT_EQ((*chart.yarns[0].color)[2], 0x72);
  EXPECT_FALSE(chart.yarns[1].color);
  EXPECT_EQ(chart.rows[0].yarn, (std::vector<int>{1, 1, 1, 1}));
  EXPECT_EQ(chart.rows[1].yarn, (std::vector<int>{0, 0, 1, 0}));
  const Knit knit = knit_chart(chart);
  ASSERT_EQ(knit.courses.size(), 3u);  // the upper row has two yarns
  EXPECT_EQ(knit.courses[1].lanes, 2);
  EXPECT_EQ(knit.courses[1].places[2].loop, -1) << "a floats behind c's stitch";
  EXPECT_GE(knit.courses[2].places[2].loop, 0);
  EXPECT_EQ(knit.loops.size(), 8u);
}

TEST(StitchChart, JsonSaysTheSame) {
  const StitchChart a = text("yarn a: #102030\nyarn b:\np c2/2f | ab4\nk5 | b\n");
  for (const char* rows : {R"(["p c4f | ab4", "k5|b"])", R"([{"stitches": ["p", "c4f"], "yarns": ["a", "b4"]},
                             {"stitches": "k5", "yarns": "b"}])"}) {
    const StitchChart b =
        json(fmt::format(R"({{"wale_chart": 1, "yarns": {{"a": "#102030", "b": null}}, "rows": {}}})", rows));
    EXPECT_EQ(chart_lines(a), chart_lines(b));
  }
}

TEST(StitchChart, LinesReadBack) {
  const StitchChart chart = text("yarn a: #102030\nyarn b: #ffffff\nko\\Sk | aabbb\ntTpks | a\nk5 | b\n");
  std::string again;
  for (const std::string& line : chart_lines(chart)) again += line + "\n";
  EXPECT_EQ(chart_lines(text(again)), chart_lines(chart));
}

// Two or three symbols side by side may spell the word of another stitch.
TEST(StitchChart, EveryTripleReadsBack) {
  std::vector<ChartCell> symbols;
  for (int s = int(Stitch::knit); s < int(Stitch::cable); ++s) symbols.push_back({Stitch(s)});
  symbols.push_back({Stitch::cable, 2, 1});
  const auto same = [](const ChartCell& a, const ChartCell& b) {
    return a.stitch == b.stitch && a.left == b.left && a.right == b.right && a.left_in_front == b.left_in_front;
  };
  const auto reads_back = [&](const std::vector<ChartCell>& cells) {
    StitchChart chart;
    chart.yarns = {{}};
    chart.rows = {{cells, {}, ""}};
    const std::string line = chart_lines(chart)[0];
    EXPECT_TRUE(std::ranges::equal(parse_chart_text(line, "c").rows[0].cells, cells, same)) << line;
  };
  for (const ChartCell& a : symbols)
    for (const ChartCell& b : symbols) {
      reads_back({a, b});
      for (const ChartCell& c : symbols) {
        reads_back({a, b, c});
        reads_back({symbols.back(), a, b, c, symbols.back()});
      }
    }
}

TEST(StitchChart, MarkOfUtf8IsNoStitch) { EXPECT_EQ(text("\xef\xbb\xbfkp\n").wales(), 2); }
TEST(StitchChart, WideCablesTakeForEver) {
  refused("c1000/1000f\n", {"c.chart:1:1", "a cable over 2000 loops; valid: up to 32"});
  EXPECT_EQ(text("c32f\n").wales(), 32);
}
// What is refused in the end must not fill the memory first.
TEST(StitchChart, TooLargeIsSaidWhereItIs) {
  std::string wide, tall;
  for (int i = 0; i < 9; ++i) wide += "c1000/1000f ";
  for (int i = 0; i < 40; ++i) tall += "k1000\n";
  refused(wide, {"c.chart:1:97", "a row of more than 16384 stitches"});
  refused(tall, {"c.chart:17:1", "at most 16384 stitches"});
}
TEST(StitchChart, UnknownSymbol) { refused("kk\nk x k\n", {"c.chart:2:3", "\"x\" is no stitch", "k2tog"}); }
TEST(StitchChart, Empty) {
  refused("", {"c.chart: no row of stitches"});
  refused("# nothing\nname: x\n", {"no row of stitches"});
}
TEST(StitchChart, DecreaseWithNothingToTake) {
  refused("kkk\nkk/\n", {"c.chart:2:3: this decrease takes 2 loops", "of the 3", "1 are left"});
}
TEST(StitchChart, CableWiderThanTheTile) {
  refused("k4\nc6f\n", {"c.chart:2:1: this cable takes 6 loops", "of the 4 of the row below (c.chart:1) 4 are left"});
}
TEST(StitchChart, RowsThatDoNotMatch) {
  refused("kkk\nkk\n", {"c.chart:2", "this row takes 2 of the 3 loops of the row below (c.chart:1)"});
  refused("k o k\nkk/k", {"c.chart"});
  refused("k/k/\n", {"c.chart:1", "this decrease takes 2 loops"});
}
TEST(StitchChart, YarnOverWithoutDecrease) { refused("kko\nkk\n", {"c.chart:2:2", "takes 2 of the 3"}); }
TEST(StitchChart, YarnThatEndsInMidAir) {
  refused("k4 | aba\n", {"c.chart:1:8: yarn a ends in mid-air: 3 of 4"});
  refused("k4 | abab2\n", {"c.chart:1", "more than the 4 stitches"});
  refused("k4 |\n", {"c.chart:1:5: no yarn is given; leave it out, or give one letter"});
}
TEST(StitchChart, YarnThatNoStitchHolds) { refused("kk\nss\n", {"c.chart:2:1", "held by none"}); }
TEST(StitchChart, LoopThatIsNeverTaken) {
  refused("kt\nkt\n", {"c.chart:2:1", "the loop of wale 2", "never taken"});
  refused("ks\nks\n", {"c.chart:2:1: wale 2 is slipped in every row"});
}
TEST(StitchChart, UnnamedYarn) {
  refused("yarn a: #000000\nkk | ab\n", {"c.chart:2:7", "no yarn is called b; there are a"});
  refused("kk | A\n", {"c.chart:1:6", "letters a to z"});
  refused("yarn a: red\nk\n", {"c.chart:1", "\"red\" is no colour", "#rrggbb"});
  refused("yarn ab: #000000\nk\n", {"c.chart:1", "named by a letter"});
  refused("yarn a:\nyarn a:\nk\n", {"c.chart:2", "already"});
  refused("k\nyarn a:\n", {"c.chart:2", "before the first row"});
}
TEST(StitchChart, AbsurdSizes) {
  refused("k0\n", {"c.chart:1:2: a count is 1 to 1000"});
  refused("k99999999999\n", {"c.chart:1:2: a count is 1 to 1000"});
  std::string wide;
  for (int i = 0; i < 20; ++i) wide += "k1000 ";
  refused(wide, {"c.chart:1", "more than 16384 stitches"});
  std::string high;
  for (int i = 0; i < 200; ++i) high += "k100\n";
  refused(high, {"c.chart:164:1: a tile has at most 16384 stitches"});
}
TEST(StitchChart, OddCables) {
  for (const char* cable : {"c3f", "c0f", "c4", "c4x", "c/1f", "c1/0b", "cf"})
    refused(std::string("kkkk\n") + cable + " k\n", {"c.chart:2:1", "is no stitch"});
}

TEST(StitchChart, BadJson) {
  json_refused("[]", {"c.json: no row"});
  json_refused("[\"\"]", {"c.json: row 1:1", "without stitches"});
  json_refused("[\"kk\", \"k x\"]", {"c.json: row 2:3", "\"x\" is no stitch"});
  json_refused("[[\"k\", \"q\"]]", {"c.json: row 1:2:1", "\"q\" is no stitch"});
  json_refused("[[\"k k\"]]", {"c.json: row 1:1", "not one word"});
  json_refused("[\"kkk\", [\"k\", \"k\", \"k2tog\"]]", {"c.json: row 2:3: this decrease takes 2"});
  json_refused("[{\"stiches\": \"kk\"}]", {"c.json: row 1: unknown key 'stiches'"});
  json_refused("[7]", {"c.json: row 1: an object is expected"});
  json_refused("[\"k\", [\"k\", 7]]", {"c.json: row 2:2: a text is expected"});
  json_refused("[{\"stitches\": [7]}]", {"c.json: row 1:1: a text is expected"});
  json_refused("[{\"stitches\": 7}]", {"c.json: row 1: a text is expected"});
  json_refused("[{\"stitches\": \"kk\", \"yarns\": [\"a\", 7]}]", {"c.json: row 1, yarns:2: a text is expected"});
  json_refused("[{\"stitches\": \"kk\", \"yarns\": [\"a\", \"a b\"]}]", {"c.json: row 1, yarns:2: \"a b\" is not one"});
  json_refused("7", {"rows", "a list is expected"});
  expect_user_error([] { json("{"); }, {"c.json:1"});
  expect_user_error([] { json(R"({"wale_chart": 2, "rows": ["k"]})"); }, {"only version 1"});
  expect_user_error([] { json(R"({"wale_chart": 1, "yarns": {"a": "red"}, "rows": ["k"]})"); }, {"yarns.a", "#rrggbb"});
  expect_user_error([] { json(R"({"wale_chart": 1, "yarns": {"ab": null}, "rows": ["k"]})"); }, {"yarns.ab", "letter"});
}

// Not those of the text that stitches and yarns would be together.
TEST(StitchChart, JsonNamesTheYarnThatIsWrong) {
  const auto yarns = [](const std::string& rows, const std::string& wanted) {
    expect_user_error(
        [&] { json(R"({"wale_chart": 1, "yarns": {"a": null, "b": null}, "rows": ["kk", )" + rows + "]}"); }, {wanted});
  };
  yarns(R"({"stitches": ["k", "k"], "yarns": ["a", "q"]})", "c.json: row 2, yarns:2: no yarn is called q");
  yarns(R"({"stitches": "kk", "yarns": "aq"})", "c.json: row 2, yarns:2: no yarn is called q");
  yarns(R"({"stitches": "kk", "yarns": ["a", "B"]})", "c.json: row 2, yarns:2: 'B' is no yarn");
  yarns(R"({"stitches": ["k", "k"], "yarns": "a ab"})", "c.json: row 2, yarns:4: yarns for more than the 2");
  yarns(R"({"stitches": "kk", "yarns": ["a", "a", "b2"]})", "c.json: row 2, yarns:3: yarns for more than the 2");
  yarns(R"({"stitches": "kkk", "yarns": ["a", "b"]})", "c.json: row 2, yarns:2: yarn b ends in mid-air: 2 of 3");
  yarns(R"({"stitches": ["k", "k", "k"], "yarns": "a b"})", "c.json: row 2, yarns:3: yarn b ends in mid-air");
  yarns(R"({"stitches": "kk", "yarns": ["a", "b0"]})", "c.json: row 2, yarns:2: a count is 1 to 1000");
  for (const char* none : {"[]", "\"\"", "\" \""})
    yarns(fmt::format(R"({{"stitches": "kk", "yarns": {}}})", none),
          "c.json: row 2, yarns:1: no yarn is given; leave it out, or give one letter");
}

// Loops: where each one is taken, what lies in front.
TEST(Loops, SlippedLoopsReachFurtherUp) {
  const Knit knit = knit_chart(text("ks\nkk\n"));
  ASSERT_EQ(knit.courses.size(), 2u);
  const Loop& held = knit.loops[size_t(knit.courses[0].places[1].loop)];
  EXPECT_EQ(held.top_row, 2);
  EXPECT_EQ(knit.courses[1].places[1].loop, -1);
}
TEST(Loops, TheLoopThatLeansLiesInFront) {
  const Knit right = knit_chart(text("o/\nkk\n")), left = knit_chart(text("\\o\nkk\n"));
  EXPECT_EQ(right.loops[0].place, 0) << "k2tog: the left one, which leans right";
  EXPECT_EQ(right.loops[1].place, 1);
  EXPECT_EQ(right.loops[0].top_wale, 1);
  EXPECT_EQ(left.loops[0].place, 1) << "ssk: the right one";
  EXPECT_EQ(left.loops[1].place, 0);
  EXPECT_EQ(left.loops[1].top_wale, 0);
}
// From the front: of two purled as one the left one lies in front, which is beneath it where they are pulled to.
TEST(Loops, PurledDecreasesAreKnittedOnesFromBehind) {
  const Knit right = knit_chart(text("o p2tog\nkk\n")), left = knit_chart(text("ssp o\nkk\n"));
  EXPECT_EQ(right.loops[0].place, 1);
  EXPECT_EQ(right.loops[1].place, 0);
  EXPECT_FALSE(right.loops[0].top_knit);
  EXPECT_EQ(left.loops[0].place, 0);
  EXPECT_EQ(left.loops[1].place, 1);
}
TEST(Loops, ThreeAreTakenInTheirOrder) {
  for (const auto& [word, places] : {std::pair{"k3tog", ivec3(0, 1, 2)},
                                     {"k3togtbl", {2, 1, 0}},
                                     {"sk2p", {1, 2, 0}},
                                     {"cdd", {2, 0, 1}},
                                     {"s2kp", {2, 0, 1}}}) {
    const Knit knit = knit_chart(text(std::string("o ") + word + " o\nkkk\n"));
    for (size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(knit.loops[i].place, places[int(i)]) << word << " " << i;
      EXPECT_EQ(knit.loops[i].beside, 3);
      EXPECT_EQ(knit.loops[i].top_wale, 1);
    }
  }
}
TEST(Loops, CablesCross) {
  const Knit knit = knit_chart(text("c2/1f\nk3\n"));
  EXPECT_EQ(knit.loops[0].crossing, 1);
  EXPECT_EQ(knit.loops[0].top_wale, 1);
  EXPECT_EQ(knit.loops[2].crossing, -1);
  EXPECT_EQ(knit.loops[2].top_wale, 0);
}
TEST(Loops, TucksAreTakenWithTheLoopTheyJoin) {
  const Knit knit = knit_chart(text("kT\nkp\n"));
  const Loop &held = knit.loops[1], &tuck = knit.loops[3];
  EXPECT_EQ(tuck.foot, Loop::Foot::tuck);
  EXPECT_FALSE(tuck.knit);
  EXPECT_EQ(held.top_row, 2);
  EXPECT_EQ(tuck.top_row, 2);
  EXPECT_EQ(held.beside, 2);
}

}  // namespace
}  // namespace wale
