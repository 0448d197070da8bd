// Progress lines and the statistics file.
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <thread>

#include "host/progress.h"
#include "host/stats.h"
#include "host/suggest.h"
#include "tests/temporary_folder.h"

namespace wale {
namespace {

// What a Progress writes into a plain file.
template <typename Call>
std::vector<std::string> progress_lines(bool quiet, Call&& call) {
  TemporaryFolder folder;
  std::FILE* out = std::fopen((folder / "log").c_str(), "w");
  {
    Progress progress("knit", quiet, out);
    call(progress);
  }
  std::fclose(out);
  std::vector<std::string> lines;
  std::ifstream in(folder / "log");
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

TEST(Progress, PlainLinesAboutEveryTenPercent) {
  const auto lines = progress_lines(false, [](Progress& p) {
    for (int i = 0; i <= 1000; ++i) p.update(i / 1000.0);
    p.finish("done");
    p.update(0.5);
    p.finish();
  });
  ASSERT_EQ(lines.size(), 10u);
  EXPECT_EQ(lines[0], "knit  10 %");
  EXPECT_EQ(lines[8], "knit  90 %");
  EXPECT_EQ(lines[9].substr(0, 18), "knit 100 %  done  ");
}

TEST(Progress, PlainLineSoonWhereATenthTakesLong) {
  const auto lines = progress_lines(false, [](Progress& p) {
    p.update(0.001);
    std::this_thread::sleep_for(std::chrono::milliseconds(1100));
    p.update(0.002);
    p.update(0.003);
  });
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0], "knit   0 %");
}

TEST(Progress, QuietSaysNothing) {
  EXPECT_TRUE(progress_lines(true, [](Progress& p) { p.update(0.5), p.finish(); }).empty());
}

TEST(Progress, OddFractionsAreHarmless) {
  const auto lines =
      progress_lines(false, [](Progress& p) { p.update(NAN), p.update(-3), p.update(0.55), p.update(7); });
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0], "knit  55 %");
}

TEST(Progress, ManyThreadsMakeWholeLines) {
  const auto lines = progress_lines(false, [](Progress& p) {
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t)
      threads.emplace_back([&p] {
        for (int i = 0; i < 1000; ++i) p.update(i / 1000.0);
      });
    for (auto& thread : threads) thread.join();
    p.finish();
  });
  EXPECT_EQ(lines.size(), 10u);
  for (const auto& line : lines) EXPECT_TRUE(line.starts_with("knit ")) << line;
}

TEST(Progress, Durations) {
  EXPECT_EQ(duration_text(0.44), "0.4 s");
  EXPECT_EQ(duration_text(12.3), "12 s");
  EXPECT_EQ(duration_text(59.9), "1 min 00 s");
  EXPECT_EQ(duration_text(200), "3 min 20 s");
  EXPECT_EQ(duration_text(7500), "2 h 05 min");
}

TEST(Stats, JsonHasThePromisedKeys) {
  Stats stats;
  stats.device = "a \xFF device";  // not UTF-8
  stats.features = {"sphere lights"};
  stats.programs = {{"trace.cl", 1.5, false}};
  stats.geometry["segments"] = {1000, 28000};
  stats.stage_seconds["knit"] = 0.25;
  stats.rays["primary"] = {2000000, 0.5};
  stats.rays["shadow"] = {10, 0};
  stats.rare_events["depth limit"] = 3;
  stats.samples = 64;
  TemporaryFolder folder;
  write_stats(stats, folder / "s.json");
  const auto json = nlohmann::json::parse(file_text(folder / "s.json"));
  for (const char* key : {"device", "features", "programs", "geometry", "stage_seconds", "rays", "samples",
                          "rare_events", "peak_memory_bytes", "total_seconds", "image", "scene"})
    EXPECT_TRUE(json.contains(key)) << key;
  EXPECT_EQ(json["programs"][0]["build_seconds"], 1.5);
  EXPECT_EQ(json["geometry"]["segments"]["bytes"], 28000);
  EXPECT_DOUBLE_EQ(json["rays"]["primary"]["mrays_per_second"], 4);
  EXPECT_TRUE(json["rays"]["shadow"]["mrays_per_second"].is_null()) << "no time, no rate";
  EXPECT_EQ(json["rays"]["all"]["count"], 2000010);
  EXPECT_GT(json["peak_memory_bytes"].get<uint64_t>(), 1u << 20);
  EXPECT_LT(json["peak_memory_bytes"].get<uint64_t>(), uint64_t(1) << 40);
}

TEST(Suggest, EditDistance) {
  EXPECT_EQ(edit_distance("fov", "fov"), 0u);
  EXPECT_EQ(edit_distance("fovv", "fov"), 1u);
  EXPECT_EQ(edit_distance("flim", "film"), 1u) << "neighbours swapped";
  EXPECT_EQ(edit_distance("", "abc"), 3u);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
}

TEST(Suggest, NearOrList) {
  EXPECT_EQ(nearest_choice("colour", {"ior", "color"}), "did you mean \"color\"?");
  EXPECT_EQ(nearest_choice("x", {"ior", "color"}), "valid: \"ior\", \"color\"");
}

}  // namespace
}  // namespace wale
