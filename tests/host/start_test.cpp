// What a start compiles, and what it finds compiled.
#include <sys/wait.h>

#include <cerrno>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>

#include "cli_fixture.h"
#include "host/kernel_note.h"
#include "host/rehearsal.h"

namespace wale::test {
namespace {

using Json = nlohmann::json;

class Start : public Cli {
 protected:
  /// Whether the programs of a render were noted as compiled.
  bool cached(const TemporaryFolder& cache, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> args{"render", scene_, "-o", at("a.png"), "--spp", "1", "--stats", at("s.json")};
    args.insert(args.end(), more.begin(), more.end());
    const Outcome run = run_wale(args, {"POCL_CACHE_DIR=" + cache.path().string()}, 300);
    EXPECT_EQ(run.status, 0) << run.err;
    const Json programs = Json::parse(file_text(folder_ / "s.json"))["programs"];
    EXPECT_GE(programs.size(), 3u);
    for (const auto& program : programs) EXPECT_EQ(program["cached"], programs[0]["cached"]);
    return programs[0]["cached"];
  }
};

TEST_F(Start, CompiledProgramsAreNotedBesideThem) {
  if (!contains(run_wale({"devices"}).out, "Portable Computing Language")) GTEST_SKIP() << "PoCL is needed";
  const TemporaryFolder cache;
  EXPECT_FALSE(cached(cache));
  const std::string picture = file_text(folder_ / "a.png");  // camera rays one by one: packets were being compiled
  EXPECT_TRUE(cached(cache));
  EXPECT_EQ(file_text(folder_ / "a.png"), picture);
  // A note where programs have gone costs time alone.
  for (const auto& entry : std::filesystem::directory_iterator(cache.path()))
    if (entry.is_directory()) {
      std::filesystem::remove_all(entry.path());
      break;
    }
  EXPECT_TRUE(cached(cache));
  EXPECT_EQ(file_text(folder_ / "a.png"), picture);
}

class KernelNotes : public testing::Test {
 protected:
  void SetUp() override {
    for (const char* name : {"POCL_CACHE_DIR", "POCL_KERNEL_CACHE"}) {
      if (const char* value = std::getenv(name)) before_[name] = value;
      unsetenv(name);
    }
    setenv("POCL_CACHE_DIR", folder_.path().c_str(), 1);
  }
  void TearDown() override {
    for (const char* name : {"POCL_CACHE_DIR", "POCL_KERNEL_CACHE"}) unsetenv(name);
    for (const auto& [name, value] : before_) setenv(name.c_str(), value.c_str(), 1);
  }
  TemporaryFolder folder_;
  std::map<std::string, std::string> before_;
};

// It would wait for the driver's threads, which it has not, and its parent for it.
TEST_F(KernelNotes, AProcessWhoseDriverRunsHasNoChildrenCompile) {
  const Device device = Device::open();
  const Rehearsal rehearsal("0", [](const DeviceTraits&) {
    return Rehearsal::Plan{wavefront_stages({}), Features().options(), {}};
  });
  EXPECT_FALSE(rehearsal.cached());
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
  EXPECT_EQ(errno, ECHILD);
}

TEST_F(KernelNotes, AreOfTheirProgramsAlone) {
  const KernelNote one("one"), other("other");
  EXPECT_FALSE(one.found());
  one.leave();
  EXPECT_TRUE(one.found());
  EXPECT_TRUE(KernelNote("one").found());
  EXPECT_FALSE(other.found());
  std::filesystem::remove_all(folder_.path());
  EXPECT_FALSE(one.found()) << "they go with the cache";
  one.leave();
  EXPECT_FALSE(one.found()) << "and make none";
}

TEST_F(KernelNotes, NoneWithoutACache) {
  EXPECT_TRUE(KernelNote::cache_is_used());
  setenv("POCL_KERNEL_CACHE", "1", 1);
  EXPECT_TRUE(KernelNote::cache_is_used());
  setenv("POCL_KERNEL_CACHE", "0", 1);
  EXPECT_FALSE(KernelNote::cache_is_used());
}

}  // namespace
}  // namespace wale::test
