// Goals on the command line: --error and --seconds, what they refuse and where they write what was reached.
#include <nlohmann/json.hpp>

#include "cli_fixture.h"
#include "host/image.h"

namespace wale::test {
namespace {

class CliGoal : public Cli {
 protected:
  std::string render_refused_with(std::vector<std::string> options) {
    std::vector<std::string> args = {"render", scene_, "-o", at("old.png")};
    args.insert(args.end(), options.begin(), options.end());
    return refused(args);
  }

  /// Renders towards a goal; the text of the program, its statistics and its picture.
  struct Told {
    std::string text;
    nlohmann::json stats;
    Image picture;
    float attribute(const std::string& name) const {
      for (const auto& [key, value] : picture.figures)
        if (key == name) return value;
      ADD_FAILURE() << "no attribute " << name;
      return -1;
    }
  };
  Told render_with(std::vector<std::string> options, const std::string& size = "40x40") {
    std::vector<std::string> args = {"render", scene_, "-o", at("a.exr"), "--stats", at("s.json"), "--size", size};
    args.insert(args.end(), options.begin(), options.end());
    const Outcome run = run_wale(args, {}, 300);
    EXPECT_EQ(run.status, 0) << run.err;
    return {run.err, nlohmann::json::parse(file_text(folder_ / "s.json")), read_image(folder_ / "a.exr", true)};
  }
};

TEST_F(CliGoal, ErrorsThatAreNone) {
  for (const char* error : {"0", "-0.1", "nan", "inf", "small"})
    EXPECT_TRUE(contains(render_refused_with({"--error", error}), "--error: " + std::string(error))) << error;
  EXPECT_TRUE(contains(render_refused_with({"--error", "0.1", "--spp", "7"}),
                       "--error 0.1 with --spp 7: noise is measured between 8 samples and more of a pixel; valid: "
                       "--spp 8 or more"));
}

TEST_F(CliGoal, AGoalThatIsReached) {
  const Told told = render_with({"--error", "0.1"});
  const auto& reached = told.stats["reached"];
  EXPECT_EQ(told.stats["goal"]["error"], 0.1);
  EXPECT_TRUE(told.stats["goal"]["seconds"].is_null());
  EXPECT_EQ(told.stats["goal"]["samples_per_pixel"], 65536);
  EXPECT_FALSE(reached["stopped"]);
  EXPECT_EQ(reached["tiles"], 25);
  EXPECT_EQ(reached["tiles_missed"], 0);
  const double worst = reached["tile_error"]["worst"], median = reached["tile_error"]["median"];
  EXPECT_LE(worst, 0.1);
  EXPECT_LE(median, worst);
  EXPECT_GT(worst, 0.05);
  EXPECT_TRUE(contains(told.text, " samples per pixel, "));
  EXPECT_TRUE(contains(told.text, "in the median; 0.1 was asked for\n"));
  // The picture says the same, tile by tile and in its header.
  const auto channel = std::find(told.picture.channels.begin(), told.picture.channels.end(), "samples");
  ASSERT_NE(channel, told.picture.channels.end());
  double sum = 0, least = 1e9, most = 0;
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x) {
      const double n = told.picture.at(x, y)[channel - told.picture.channels.begin()];
      sum += n, least = std::min(least, n), most = std::max(most, n);
    }
  const auto& samples = reached["samples_per_pixel"];
  EXPECT_NEAR(samples["mean"].get<double>(), sum / 1600, 1e-9);
  EXPECT_EQ(samples["least"].get<double>(), least);
  EXPECT_EQ(samples["most"].get<double>(), most);
  EXPECT_NEAR(told.attribute("wale:samples.mean"), sum / 1600, 1e-3);
  EXPECT_NEAR(told.attribute("wale:error.worst"), worst, 1e-6);
  EXPECT_NEAR(told.attribute("wale:goal.error"), 0.1, 1e-6);
}

TEST_F(CliGoal, AGoalThatCannotBeReachedSaysSo) {
  const Told told = render_with({"--error", "1e-7", "--spp", "16"});
  const int missed = told.stats["reached"]["tiles_missed"];
  EXPECT_GT(missed, 0);
  EXPECT_TRUE(contains(told.text, "16 samples per pixel in "));
  EXPECT_TRUE(contains(told.text, "1e-07 was asked for and missed in " + std::to_string(missed) +
                                      " of 25 tiles at the limit of 16 samples\n"));
}

TEST_F(CliGoal, SecondsAreKept) {
  render_with({"--spp", "8"});  // so that the clock below holds no compilation
  for (const auto& goal : {std::vector<std::string>{}, {"--error", "1e-4"}}) {
    std::vector<std::string> options = {"--seconds", "2"};
    options.insert(options.end(), goal.begin(), goal.end());
    const Told told = render_with(options, "200x200");
    const double seconds = told.stats["total_seconds"], mean = told.stats["reached"]["samples_per_pixel"]["mean"];
    const double pass = seconds * 8 / mean;  // of eight samples of every pixel
    EXPECT_LT(seconds, 2 * 1.05 + pass);
    EXPECT_GT(seconds, 2 * 0.95 - pass);
    EXPECT_TRUE(told.stats["reached"]["stopped"]);
    EXPECT_EQ(told.stats["goal"]["seconds"], 2);
    EXPECT_GE(told.stats["reached"]["samples_per_pixel"]["least"], 1);
    EXPECT_TRUE(contains(told.text, "error of a tile: "));
  }
}

}  // namespace
}  // namespace wale::test
