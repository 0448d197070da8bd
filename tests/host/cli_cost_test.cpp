// `wale cost` as a program: what it refuses, and what it leaves when it is stopped.
#include <csignal>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "cli_fixture.h"
#include "host/accuracy.h"
#include "host/image.h"

namespace wale::test {
namespace {

class CliCost : public Cli {
 protected:
  std::string cost_refused(std::vector<std::string> options) {
    std::vector<std::string> args = {"cost", scene_, "-o", at("cost")};
    args.insert(args.end(), options.begin(), options.end());
    return refused(args);
  }
  std::string reference(const std::vector<std::string>& options = {}, const std::string& name = "ref.exr") {
    std::vector<std::string> args = {"render", scene_, "-o", at(name), "--spp", "8", "--size", "12x12", "--quiet"};
    args.insert(args.end(), options.begin(), options.end());
    const Outcome run = run_wale(args, {}, 300);
    EXPECT_EQ(run.status, 0) << run.err;
    return at(name);
  }
};

TEST_F(CliCost, UnknownOptionIsAnsweredWithTheNearest) {
  EXPECT_TRUE(
      contains(cost_refused({"--options", "curve"}), "--options curve: no such option; did you mean \"curves\"?"));
  EXPECT_TRUE(contains(cost_refused({"--minutes", "0"}), "--minutes: 0: a number above 0 is needed"));
  EXPECT_TRUE(contains(cost_refused({"--size", "12"}), "--size 12: expected WIDTHxHEIGHT"));
}

TEST_F(CliCost, OutputMustBeAFolder) {
  EXPECT_TRUE(contains(refused({"cost", scene_, "-o", at("old.png")}), "old.png: this is a file; give a folder"));
  EXPECT_TRUE(contains(refused({"cost", scene_, "-o", at("none/cost")}), "the folder none does not exist"));
  EXPECT_TRUE(contains(refused({"cost", scene_}), "--output is required"));
}

TEST_F(CliCost, ReferenceOfAnotherSceneOrSize) {
  const std::string file = reference();
  EXPECT_TRUE(contains(cost_refused({"--reference", file, "--size", "16x16"}), "ref.exr: is 12 x 12, --size is 16x16"));
  EXPECT_TRUE(contains(cost_refused({"--reference", file, "--set", "fabrics.0.yarn.plies=2"}), "shows another scene"));
  EXPECT_TRUE(contains(cost_refused({"--reference", at("none.exr")}), "none.exr: no such image file"));
  write_image(Image{12, 12, {"R", "G", "B"}, std::vector<float>(432, 0.5f)}, folder_ / "plain.exr");
  EXPECT_TRUE(contains(cost_refused({"--reference", at("plain.exr")}), "does not say which scene it shows"));
}

TEST_F(CliCost, RendersSayWhatTheyShow) {
  const Image first = read_image(reference({"--preset", "draft"}));
  const Image second = read_image(reference({"--set", "integrator.max_depth=3"}, "second.exr"));
  const Image other = read_image(reference({"--set", "fabrics.0.yarn.plies=2"}, "other.exr"));
  EXPECT_EQ(first.attributes.at("wale:scene"), second.attributes.at("wale:scene"));
  EXPECT_NE(first.attributes.at("wale:scene"), other.attributes.at("wale:scene"));
  EXPECT_TRUE(contains(first.attributes.at("wale:accuracy"), "depth 4"));
  EXPECT_TRUE(contains(second.attributes.at("wale:accuracy"), "depth 3"));
}

// Ctrl-C while it measures: the report of what there is, whole.
TEST_F(CliCost, StoppedItWritesItsReport) {
  TemporaryFolder printed;
  Process process(printed.path(), {"cost", scene_, "-o", at("cost"), "--size", "12x12", "--minutes", "1", "--options",
                                   "depth", "--set", "integrator.light_sampling=light"});
  ASSERT_TRUE(process.wait_for("measure ", 300)) << process.err();
  // The next line comes after a tenth of the time, when the scene and its reference have been rendered.
  const auto lines_of_progress = [&] {
    const std::string text = process.err();
    return text.find("measure ", text.find("measure ") + 1) != std::string::npos;
  };
  for (int i = 0; i < 3000 && !lines_of_progress(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  process.signal(SIGINT);
  EXPECT_EQ(process.wait(60), 0) << process.err();
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_ / "cost"), {}), 5);
  const auto json = nlohmann::json::parse(file_text(folder_ / "cost" / "cost.json"));
  EXPECT_EQ(json["ended_early"], "stopped");
  const size_t rows = accuracy_option("depth").levels.size();
  EXPECT_EQ(json["levels"].size(), rows);
  EXPECT_TRUE(contains(json["command"].get<std::string>(), " cost "));
  std::istringstream csv(file_text(folder_ / "cost" / "cost.csv"));
  std::string line;
  size_t csv_lines = 0, fields = 0;
  for (; std::getline(csv, line); ++csv_lines) {
    bool quoted = false;
    size_t n = 1;
    for (const char c : line) quoted ^= c == '"', n += c == ',' && !quoted;
    if (csv_lines == 0) fields = n;
    EXPECT_EQ(n, fields) << line;
  }
  EXPECT_EQ(csv_lines, rows + 1);
  const std::string page = file_text(folder_ / "cost" / "index.html");
  EXPECT_TRUE(contains(page, "<svg"));
  EXPECT_TRUE(contains(page, "data:image/png;base64,iVBORw0KGgo"));
  EXPECT_TRUE(page.ends_with("</html>\n"));
  for (const char* outside : {"src=\"http", "href=\"http", "url(http", "<script"})
    EXPECT_FALSE(contains(page, outside));
  EXPECT_TRUE(contains(process.out(), "time to equal noise"));
  EXPECT_TRUE(contains(process.out(), "left out: ") || contains(process.out(), "the reference"));
}

}  // namespace
}  // namespace wale::test
