// A render that is stopped keeps its picture: Ctrl-C, SIGTERM and --seconds.
#include <cmath>
#include <csignal>
#include <nlohmann/json.hpp>

#include "cli_fixture.h"
#include "host/image.h"

namespace wale::test {
namespace {

class CliStop : public Cli {
 protected:
  void expect_picture(const std::string& name) {
    const Image image = read_image(folder_ / name, true);  // refuses NaN and infinity
    EXPECT_EQ(image.width, 64);
    EXPECT_EQ(image.height, 64);
    size_t lit = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) lit += image.at(x, y)[0] > 0;
    EXPECT_GT(lit, 0u);
  }
};

class CliSignal : public CliStop, public testing::WithParamInterface<int> {};
INSTANTIATE_TEST_SUITE_P(Signals, CliSignal, testing::Values(SIGINT, SIGTERM), [](const auto& which) {
  return std::string(which.param == SIGINT ? "Interrupt" : "Terminate");
});

TEST_P(CliSignal, KeepsThePicture) {
  TemporaryFolder printed;
  const size_t files = folder_.files();
  Process process(printed.path(), {"render", scene_, "-o", at("a.exr"), "-o", at("a.png"), "--stats", at("s.json"),
                                   "--size", "64x64", "--spp", "1000000"});
  ASSERT_TRUE(process.wait_for("render ", 120)) << process.err();
  const double asked = process.seconds();
  process.signal(GetParam());
  EXPECT_EQ(process.wait(60), 0) << process.err();
  EXPECT_LT(process.seconds() - asked, 10);
  EXPECT_TRUE(contains(process.err(), "stopped early"));
  EXPECT_EQ(folder_.files(), files + 3);  // and no temporary ones
  expect_picture("a.exr");
  expect_picture("a.png");
  const auto stats = nlohmann::json::parse(file_text(folder_ / "s.json"));
  EXPECT_GT(stats["samples"].get<uint64_t>(), 0u);
  EXPECT_LT(stats["image"]["samples_per_pixel"].get<double>(), 1000000);
}

TEST_F(CliStop, SecondsEndInTime) {
  // Built once before, so that the clock below holds no compilation.
  ASSERT_EQ(run_wale({"render", scene_, "-o", at("w.exr"), "--size", "64x64", "--spp", "8"}, {}, 300).status, 0);
  const Outcome run =
      run_wale({"render", scene_, "-o", at("a.exr"), "--size", "64x64", "--seconds", "1", "--stats", at("s.json")});
  EXPECT_EQ(run.status, 0) << run.err;
  expect_picture("a.exr");
  const auto stats = nlohmann::json::parse(file_text(folder_ / "s.json"));
  EXPECT_GT(stats["total_seconds"].get<double>(), 0.95);
  EXPECT_LT(stats["total_seconds"].get<double>(), 4.0);
  EXPECT_LT(run.seconds, 15);
}

}  // namespace
}  // namespace wale::test
