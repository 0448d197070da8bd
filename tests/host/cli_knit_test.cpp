// `wale knit`: a tile beside its report, the gauge, and what it leaves behind when it fails or is stopped.
#include <chrono>
#include <csignal>
#include <nlohmann/json.hpp>

#include "cli_fixture.h"
#include "geom/pattern.h"
#include "tests/tolerances.h"

namespace wale::test {
namespace {

class CliKnit : public Cli {
 protected:
  std::string chart(const std::string& text, const std::string& name = "c.chart") {
    return folder_.write(name, text).string();
  }
  Outcome knit(const std::string& file, const std::string& tile, const std::vector<std::string>& more = {}) {
    std::vector<std::string> args = {"knit", file, "-o", at(tile), "--json", at("report.json")};
    args.insert(args.end(), more.begin(), more.end());
    return run_wale(args, {kNoDevice});
  }
  nlohmann::json report() { return nlohmann::json::parse(file_text(folder_ / "report.json")); }
  std::string knit_refused(const std::string& file, const std::vector<std::string>& more = {}) {
    std::vector<std::string> args = {"knit", file, "-o", at("tile.json")};
    args.insert(args.end(), more.begin(), more.end());
    return refused(args, 1, {kNoDevice});
  }
};

TEST_F(CliKnit, TileHoldsItsChartAndSettings) {
  const Outcome run = knit(chart("k p\n"), "tile.json", {"--yarn", "2", "--loop", "25"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_TRUE(contains(run.out, "loop length  25.0000 mm, 12.500 yarn diameters of 2 mm"));
  const Pattern tile = read_pattern(folder_ / "tile.json");
  EXPECT_EQ(tile.yarn_radius, 1e-3);
  EXPECT_EQ(tile.stitches, ivec2(2, 1));
  EXPECT_EQ(tile.chart, std::vector<std::string>{"kp"});
  EXPECT_TRUE(tile.palette.empty());
  const auto json = nlohmann::json::parse(file_text(folder_ / "tile.json"));
  EXPECT_EQ(json["knitted_from"]["settings"]["loop_length"], 0.025);
  const auto told = report();
  EXPECT_NEAR(told["wales_per_10cm"].get<double>(), 0.1 * 2 / tile.period.x, 1e-3);
  EXPECT_GE(told["closest"].get<double>(), 0.95);
  EXPECT_LE(told["force"].get<double>(), told["force_wanted"].get<double>());
  EXPECT_GT(told["processor_seconds"].get<double>(), 0);
}

TEST_F(CliKnit, SameBytesAgain) {
  const std::string file = chart("p\nk\n");
  ASSERT_EQ(knit(file, "a.json").status, 0);
  ASSERT_EQ(knit(file, "b.json").status, 0);
  EXPECT_EQ(file_text(folder_ / "a.json"), file_text(folder_ / "b.json"));
}

TEST_F(CliKnit, LoopLengthFollowsFromTheGauge) {
  const Outcome run = knit(chart("k\n"), "tile.json", {"--yarn", "1.5", "--wales", "15"});
  ASSERT_EQ(run.status, 0) << run.err;
  const auto told = report();
  EXPECT_NEAR(told["wales_per_10cm"].get<double>(), 15, 15 * 0.0051);
  EXPECT_NEAR(read_pattern(folder_ / "tile.json").period.x, 0.1 / 15, 0.1 / 15 * 0.0051);
  EXPECT_GT(told["loop_lengths_tried"].get<int>(), 1);
}

TEST_F(CliKnit, AGaugeThatNoLoopGivesEndsSoon) {
  const auto start = std::chrono::steady_clock::now();
  for (const char* asked : {"--wales", "--courses"}) {
    const std::string line = knit_refused(chart("k\n"), {asked, "150", "--quiet"});
    EXPECT_TRUE(contains(line, "no loop length gives this gauge, nothing is written; the nearest is 26.")) << line;
    EXPECT_TRUE(contains(line, "--loop 12.")) << line << ": shorter ones fit only where the yarn stretches";
  }
  // The first loop length that is tried jams, and the next is far too long.
  const std::string line = knit_refused(chart("tt\nkk\n"), {"--wales", "150", "--quiet"});
  EXPECT_TRUE(contains(line, "the nearest is 2") && contains(line, "--loop 15.")) << line;
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 20) << "2 s idle";
}

// 26 wales are those of a loop of 13 mm, which takes 117 steps; one of 17 mm takes 58.
TEST_F(CliKnit, AGaugeThatTakesMoreStepsIsNotSaidToBeImpossible) {
  const std::string line = knit_refused(chart("k\n"), {"--wales", "25.5", "--steps", "90", "--quiet"});
  EXPECT_TRUE(contains(line,
                       "no loop length that was relaxed in 90 --steps gives this gauge, nothing is written; more of "
                       "them may do; the nearest is 2"))
      << line;
  EXPECT_EQ(knit(chart("k\n"), "tile.json", {"--wales", "25.5", "--steps", "900", "--quiet"}).status, 0);
}

TEST_F(CliKnit, TimeIsLimited) {
  const std::string file = chart("p2 k4 p2\np2 c4f p2\n");
  for (const std::vector<std::string>& more : {std::vector<std::string>{}, {"--wales", "60"}}) {
    std::vector<std::string> args = {"--seconds", "0.02", "--quiet"};
    args.insert(args.end(), more.begin(), more.end());
    const std::string line = knit_refused(file, args);
    EXPECT_TRUE(contains(line, "could not be relaxed, nothing is written: the 0.02 s of --seconds are over")) << line;
    EXPECT_TRUE(contains(line, more.empty() ? "; more --seconds or fewer --starts may do" : "; more --seconds may do"))
        << line << ": a search for a gauge has one start anyway";
  }
}

// Before the first step: half of the points are taken off first, from every start.
TEST_F(CliKnit, TimeIsLimitedOfWideCablesToo) {
  const auto start = std::chrono::steady_clock::now();
  EXPECT_TRUE(
      contains(knit_refused(chart("c32f\n"), {"--seconds", "0.1", "--starts", "64", "--threads", "1", "--quiet"}),
               "--seconds are over"));
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 10) << "0.4 s idle";
}

TEST_F(CliKnit, WhatStoppedItIsSaid) {
  const std::string file = chart("k\n");
  const std::string steps = knit_refused(file, {"--steps", "40", "--quiet"}),
                    loop = knit_refused(file, {"--loop", "9", "--quiet"});
  EXPECT_TRUE(contains(steps, "the 40 --steps are done")) << steps;
  EXPECT_TRUE(contains(steps, "more of them may do")) << steps;
  EXPECT_TRUE(contains(loop, "the yarn jams (stretched by")) << loop;
  EXPECT_TRUE(contains(loop, "a longer --loop may do")) << loop;
}

// A period that is held is no licence to stretch the yarn: what is told instead of it holds, and lies on the way to it.
TEST_F(CliKnit, AHeldPeriodThatStretchesTheYarnIsRefusedWithTheNearestThatHolds) {
  const std::string file = chart("k\n"), told = "the nearest that holds, on the way to the free one, is --period ";
  for (const char* asked : {"6x3", "12x2", "2.2x2", "3.926x1.2"}) {
    const std::string line = knit_refused(file, {"--starts", "1", "--period", asked, "--quiet"});
    ASSERT_TRUE(contains(line, "could not be relaxed, nothing is written: the yarn jams")) << asked << ": " << line;
    ASSERT_TRUE(contains(line, told)) << asked << ": " << line;
    const std::string nearest = line.substr(line.find(told) + told.size());
    const std::string period = nearest.substr(0, nearest.find_first_not_of("0123456789.x"));
    const Outcome run = knit(file, "tile.json", {"--starts", "1", "--period", period, "--quiet"});
    EXPECT_EQ(run.status, 0) << asked << " -> " << period << ": " << run.err;
    EXPECT_LE(report()["strain"].get<double>(), 0.03) << period;
  }
}

// The table of strains is not relaxed for the advice.
TEST_F(CliKnit, TheNearestPeriodIsSaidToBeWithoutStrains) {
  const std::string line = knit_refused(chart("k\n"), {"--starts", "1", "--period", "6x3", "--strains", "--quiet"});
  EXPECT_TRUE(contains(line, "the nearest that holds without --strains, on the way to the free one, is --period "))
      << line;
}

// Rows of nothing but tucks put two yarns through every loop: 13.2 diameters of yarn do not go round them. From a jam
// the energy can only rise, and that is seen long before the steps are done.
TEST_F(CliKnit, RowsOfTucksNeedALongerLoop) {
  const std::string file = chart("tt\nkk\n");
  const auto start = std::chrono::steady_clock::now();
  EXPECT_TRUE(contains(knit_refused(file, {"--quiet"}), "the yarn jams"));
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 15) << "1 s; it was 36 s";
  EXPECT_EQ(knit(file, "tile.json", {"--loop", "18", "--quiet"}).status, 0);
}

// Tile and table of strains, several starts.
TEST_F(CliKnit, SameBytesWithAnyNumberOfThreads) {
  const std::string file = chart("kp\npk\n");
  for (const char* threads : {"1", "2", "5"})
    ASSERT_EQ(knit(file, std::string(threads) + ".json", {"--strains", "--threads", threads, "--loop", "15"}).status,
              0);
  EXPECT_EQ(file_text(folder_ / "1.json"), file_text(folder_ / "2.json"));
  EXPECT_EQ(file_text(folder_ / "1.json"), file_text(folder_ / "5.json"));
}

TEST_F(CliKnit, StrainsOpenTheLoops) {
  const Outcome run = knit(chart("k\n"), "tile.json", {"--strains"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_TRUE(contains(run.out, "strains      5 x 5, from -0.2 to 1"));
  EXPECT_TRUE(contains(run.err, "knit 100 %")) << run.err;
  const Pattern tile = read_pattern(folder_ / "tile.json");
  const StrainTable& table = tile.strains;
  ASSERT_EQ(table.course, (std::vector<double>{-0.2, 0, 0.25, 0.5, 1}));
  ASSERT_EQ(table.wale, table.course);
  const std::vector<dvec3>& q = tile.curves[0].points;
  const auto length = [&](size_t course, size_t wale) {
    const std::vector<dvec3>& g = table.offsets[wale * 5 + course];
    double sum = 0;
    for (size_t i = 1; i < q.size(); ++i)
      sum +=
          glm::length((q[i] - q[i - 1] + g[i] - g[i - 1]) * dvec3(1 + table.course[course], 1 + table.wale[wale], 1));
    return sum;
  };
  // MADYPG's table of stockinette says 0.0703; affine would be more than 0.2.
  EXPECT_NEAR(length(3, 1) / length(1, 1) - 1, 0.0703, 0.1 * 0.0703);
  EXPECT_GT(length(0, 1) / length(1, 1) - 1, -0.01) << "cloth is compressed, yarn is not";
}

TEST_F(CliKnit, PeriodIsHeld) {
  ASSERT_EQ(knit(chart("k\n"), "tile.json", {"--period", "4.3x2"}).status, 0);
  const Pattern tile = read_pattern(folder_ / "tile.json");
  EXPECT_NEAR(tile.period.x, 4.3e-3, 1e-9);
  EXPECT_NEAR(tile.period.y, 2e-3, 1e-9);
}

TEST_F(CliKnit, ColoursReachTheTile) {
  ASSERT_EQ(knit(chart("yarn a: #102030\nyarn b: #ffeedd\nk2 | ab\nk2 | ba\n"), "tile.json").status, 0);
  const Pattern tile = read_pattern(folder_ / "tile.json");
  ASSERT_EQ(tile.palette.size(), 2u);
  EXPECT_EQ(tile.palette[1][2], 0xdd);
  ASSERT_EQ(tile.curves.size(), 4u);
  EXPECT_EQ(tile.curves[0].yarn, 0);
  EXPECT_EQ(tile.curves[1].yarn, 1);
}

TEST_F(CliKnit, ChartErrorsNameRowAndColumn) {
  EXPECT_TRUE(contains(knit_refused(chart("kk\nkx\n")), "c.chart:2:2: \"x\" is no stitch"));
  EXPECT_TRUE(contains(knit_refused(chart("")), "c.chart: no row of stitches"));
  EXPECT_TRUE(contains(knit_refused(chart("[", "c.json")), "c.json:1"));
  EXPECT_TRUE(contains(knit_refused(chart("knit", "c.knitout")), "c.knitout:1"));
  EXPECT_TRUE(contains(knit_refused(at("none.chart")), "none.chart"));
}

TEST_F(CliKnit, SettingsOutOfProportion) {
  const std::string file = chart("k\n");
  EXPECT_TRUE(contains(knit_refused(file, {"--yarn", "nan"}), "--yarn: nan: a number above 0 is needed"));
  EXPECT_TRUE(contains(knit_refused(file, {"--yarn", "1e9"}), "a yarn thickness of 1e+09 mm; valid: 0.01 to 100 mm"));
  EXPECT_TRUE(contains(knit_refused(file, {"--loop", "1"}), "a loop length of 1 yarn diameters; valid: 6 to 100"));
  EXPECT_TRUE(contains(knit_refused(file, {"--step", "9"}), "a resolution of 9"));
  EXPECT_TRUE(contains(knit_refused(file, {"--course-tension", "-1"}), "a number of at least 0"));
  EXPECT_TRUE(contains(knit_refused(file, {"--period", "3"}), "expected WIDTHxHEIGHT"));
  EXPECT_TRUE(contains(knit_refused(file, {"--period", "nanx3"}), "a period of nan"));
  EXPECT_TRUE(contains(knit_refused(file, {"--period", "0x0"}), "a period of 0 yarn diameters; valid: 0.5"));
  EXPECT_TRUE(contains(knit_refused(file, {"--period", "0x10x5"}), "expected WIDTHxHEIGHT"));
  EXPECT_TRUE(contains(knit_refused(file, {"--period", "90000x2"}),
                       "the yarn of this loop length does not reach; valid: up to 13.2 x 6.6 mm"));
  EXPECT_TRUE(contains(knit_refused(file, {"--period", "4x7"}), "does not reach"));
  for (const char* pull : {"--blocking", "--course-tension", "--wale-tension"})
    EXPECT_TRUE(contains(knit_refused(file, {"--period", "4.3x2", pull, "0.5"}),
                         "a period that is held is not pulled at; leave it out, or blocking and tension"))
        << pull;
  EXPECT_TRUE(contains(knit_refused(file, {"--wales", "20", "--courses", "30"}), "ask for one of them"));
  EXPECT_TRUE(contains(knit_refused(file, {"--loop", "12", "--wales", "20"}), "ask for one of them"));
}

TEST_F(CliKnit, TileIsJson) {
  EXPECT_TRUE(contains(refused({"knit", chart("k\n"), "-o", at("tile.txt")}, 1, {kNoDevice}), "written as .json"));
  EXPECT_TRUE(contains(refused({"knit", chart("k\n"), "-o", at("none/tile.json")}, 1, {kNoDevice}), "does not exist"));
}

TEST_F(CliKnit, NeitherChartNorTileIsWrittenOver) {
  const std::string text = R"({"wale_chart": 1, "rows": ["k"]})", file = chart(text, "c.json");
  EXPECT_TRUE(contains(refused({"knit", file, "-o", at("./c.json")}, 1, {kNoDevice}), "is the chart itself"));
  EXPECT_EQ(file_text(folder_ / "c.json"), text);
  EXPECT_TRUE(contains(knit_refused(file, {"--json", at("./tile.json")}), "is the tile; give the report another name"));
}

// Held far too narrow, the yarns do not fit side by side.
TEST_F(CliKnit, WhatCannotBeRelaxedIsNotWritten) {
  const std::string line = knit_refused(chart("k\n"), {"--period", "1.2x1", "--steps", "40", "--quiet"});
  EXPECT_TRUE(contains(line, "could not be relaxed, nothing is written"));
  EXPECT_TRUE(contains(line, "% of its thickness"));
}

TEST_F(CliKnit, CtrlCWritesNothing) {
  std::string large;
  for (int row = 0; row < 12; ++row) large += "p2 k4 p2 c4f p2 k4 p2 c4f\n";
  const std::string file = chart(large);
  const size_t files = folder_.files();
  TemporaryFolder printed;
  Process process(printed.path(), {"knit", file, "-o", at("tile.json")}, {kNoDevice});
  ASSERT_TRUE(process.wait_for("knit ", 60)) << process.err();
  process.signal(SIGINT);
  EXPECT_EQ(process.wait(60), 1) << process.err();
  EXPECT_TRUE(contains(process.err(), "stopped, nothing is written"));
  EXPECT_EQ(folder_.files(), files);
}

}  // namespace
}  // namespace wale::test
