// Levels whose bias and price are known to differ, measured on a small scene.
#include <fmt/format.h>

#include <cmath>

#include "geom/base_mesh.h"
#include "host/cost/experiment.h"
#include "tests/image/picture.h"
#include "tests/temporary_folder.h"
#include "tests/tolerances.h"

namespace wale::cost {
namespace {

constexpr const char* kScene = R"({"wale": 1, "units": "mm", "camera": {"position": [0, 0, 60]},
 "materials": {"yarn": {"type": "ply", "preset": "cotton", "color": [0.9, 0.8, 0.7]}},
 "fabrics": [{"name": "cloth", "mesh": {"generator": "swatch", "width": 20, "height": 20},
  "pattern": {"builtin": "stockinette"}, "gauge": {"wales": 30}, "material": "yarn"}]})";
constexpr double kSeconds = 4;
constexpr size_t kRounds = 8;

const Loaders kLoaders{[](const auto& file) { return read_mesh(file); },
                       [](const auto& file) { return read_image(file, true); }};

class CostExperiment : public testing::Test {
 protected:
  // The clock stands, so that what other programs on the machine do leaves the plan as it is, until kRounds are done.
  CostReport run(const std::string& options, double seconds, const std::vector<std::string>& set = {},
                 std::optional<GivenReference> given = {}) {
    Levels levels = collect_levels(folder_.write("scene.json", kScene), set, wanted_options(options), {24, 24});
    const size_t renders = kRounds * levels.units.size();
    size_t begun = 0;
    Experiment experiment(test::device(), kLoaders, std::move(levels), std::move(given), seconds,
                          [&] { return begun > renders ? 2 * seconds : 0; }, {});
    experiment.survey([](const std::string&, double) {});
    experiment.measure([&](const std::string&, double) { ++begun; });
    return experiment.report();
  }
  const UnitResult& find(const CostReport& report, const std::string& option, const std::string& level) {
    for (const Level& row : report.levels.rows)
      if (row.option == option && row.level == level) return report.results.at(*row.unit);
    throw std::out_of_range(option + " " + level);
  }
  TemporaryFolder folder_;
};

TEST_F(CostExperiment, RanksLevelsThatAreFarApart) {
  const CostReport report = run("depth,light_sampling,curves,joints", 2 * kSeconds);
  for (const UnitResult& r : report.results) {
    EXPECT_EQ(r.left_out, "");
    EXPECT_GE(r.repetitions, kFewestRepetitions);
    EXPECT_GT(r.start.bytes, 0u);
  }
  // Two events of scattering are cheaper and darker than all of them; four lie between.
  const UnitResult &two = find(report, "depth", "2"), &four = find(report, "depth", "4");
  const UnitResult& all = find(report, "depth", "0");
  EXPECT_TRUE(two.bias.resolved());
  EXPECT_TRUE(four.bias.resolved());
  EXPECT_GT(two.bias.low(), four.bias.high());
  EXPECT_GT(four.bias.low(), all.bias.high());
  EXPECT_GT(two.flip, four.flip);
  EXPECT_LT(two.time.high, four.time.middle);
  EXPECT_LT(four.time.middle, 1);
  EXPECT_EQ(all.time.middle, 1);
  EXPECT_EQ(all.equal_noise.high, 1);
  // How light is sampled changes noise alone.
  for (const char* level : {"bsdf", "light"}) {
    const Bias& change = find(report, "light_sampling", level).change;
    EXPECT_GT(change.standard_error, 0);
    EXPECT_LT(std::abs(change.relative_mse), tolerance::kStandardErrors * change.standard_error) << level;
  }
  // Coarser curves lie farther from those of the reference, at most by their two tolerances.
  double last = 1;
  for (const auto& [level, tolerance] : {std::pair{"0.4", 0.4}, {"0.2", 0.2}, {"0.1", 0.1}, {"0.05", 0.05}}) {
    const std::optional<double> radii = find(report, "curves", level).radii;
    ASSERT_TRUE(radii.has_value()) << level;
    EXPECT_LT(*radii, last) << level;
    EXPECT_GT(*radii, 0.3 * tolerance) << level;
    EXPECT_LT(*radii, tolerance + 0.02 + 0.01) << level;
    last = *radii;
  }
  // What is chosen where leaves are packed comes to the device.
  for (const char* level : {"open", "capsule"})
    EXPECT_NE(find(report, "joints", level).change.relative_mse, 0) << level;
  EXPECT_GT(find(report, "curves", "0.02").start.bytes, find(report, "curves", "0.4").start.bytes);
  EXPECT_FALSE(find(report, "curves", "0.02").radii.has_value());  // the reference itself
  EXPECT_EQ(find(report, "curves", "0.02").bias.relative_mse, 0);
}

TEST_F(CostExperiment, AGivenReferenceIsCompared) {
  const CostReport made = run("depth", kSeconds, {"integrator.max_depth=4", "fabrics.*.tolerance=0.2"});
  // Of depth 4: the scene as it is has no bias against it, and a deeper one has.
  GivenReference given{"given.exr", find(made, "depth", "4").mean, {}, "depth 4", 64};
  given.variance.assign(given.picture.rgb.size(), 0.0f);
  const std::vector<double> weights = relative_weights(given.picture);
  const UnitResult& source = find(made, "depth", "4");
  const double paths = double(source.samples) * source.repetitions;
  for (size_t p = 0; p < weights.size(); ++p)
    for (size_t c = 0; c < 3; ++c)
      given.variance[3 * p + c] = float(source.variance / paths / (weights[p] * 3 * double(weights.size())));
  const CostReport report = run("depth", kSeconds, {"integrator.max_depth=4", "fabrics.*.tolerance=0.2"}, given);
  EXPECT_NE(report.reference_text.find("given.exr"), std::string::npos);
  EXPECT_FALSE(report.reference_made);
  EXPECT_LT(find(report, "depth", "4").bias.relative_mse, 0.1 * find(report, "depth", "0").bias.relative_mse);
  EXPECT_TRUE(find(report, "depth", "0").bias.resolved());
}

// A lattice lays its tiles from the corner of the UVs on; stored yarns lie as tiles from UV 0 on do.
TEST_F(CostExperiment, TilesThatLieElsewhereAreNotCompared) {
  const auto square = [&](double begin) {  // 20 mm, one unit of UV, 8 x 8 tiles
    std::string text;
    for (const auto& [x, y] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 1}})
      text += fmt::format("v {} {} 0\nvt {} {}\n", 0.02 * x - 0.01, 0.02 * y - 0.01, begin + x, y);
    return folder_.write("square.obj", text + "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n").string();
  };
  for (const double begin : {0.0, 0.0625}) {
    const CostReport report = run(
        "warp", kSeconds / 4, {"fabrics.0.mesh=" + square(begin), "fabrics.0.gauge={\"wales\": 40, \"courses\": 40}"});
    for (const Level& row : report.levels.rows) {
      const std::string why = report.results.at(*row.unit).left_out;
      EXPECT_EQ(why.find("its tiles lie 0.5 x 0 tiles from") != std::string::npos, begin > 0 && row.level != "mesh")
          << row.level << ": " << why;
    }
  }
}

// Where the preset "reference" has no room, the scene itself takes its part, and the report says so.
TEST_F(CostExperiment, AReferenceThatDoesNotFitIsSaid) {
  Levels levels = collect_levels(folder_.write("scene.json", kScene), {}, wanted_options("light_sampling"), {24, 24});
  // Refused when it is built, as one that has no room is.
  levels.units[levels.reference].scene.fabrics[0].color_image.file = folder_ / "none.png";
  size_t begun = 0;
  Experiment experiment(test::device(), kLoaders, std::move(levels), {}, kSeconds,
                        [&] { return begun > 12 ? 2 * kSeconds : 0; }, {});
  experiment.survey([](const std::string&, double) {});
  experiment.measure([&](const std::string&, double) { ++begun; });
  const CostReport report = experiment.report();
  EXPECT_EQ(report.levels.reference, 0u);
  EXPECT_NE(report.reference_text.find("the scene itself, as a more accurate one cannot be held ("), std::string::npos);
  EXPECT_EQ(report.base().bias.relative_mse, 0);
}

TEST_F(CostExperiment, TooLittleTimeIsSaid) {
  Experiment experiment(test::device(), kLoaders,
                        collect_levels(folder_.write("scene.json", kScene), {}, wanted_options("depth"), {24, 24}), {},
                        1e-6, [] { return 0.0; }, {});
  const auto silent = [](const std::string&, double) {};
  experiment.survey(silent);
  const std::string message = user_message([&] { experiment.measure(silent); });
  EXPECT_NE(message.find("the scene and its reference alone need"), std::string::npos) << message;
}

// Ten and a half courses are no whole tiles; ten are.
TEST_F(CostExperiment, LatticesThatMoveStitchesAreLeftOut) {
  const CostReport moved = run("warp", kSeconds);
  for (const char* level : {"1", "2", "4"})
    EXPECT_NE(find(moved, "warp", level).left_out.find("whole tiles of 3.333 x 2 mm"), std::string::npos)
        << find(moved, "warp", level).left_out;
  const CostReport same = run("warp", 2 * kSeconds, {"fabrics.cloth.mesh.height=19.0986"});
  EXPECT_EQ(find(same, "warp", "2").left_out, "");
}

}  // namespace
}  // namespace wale::cost
