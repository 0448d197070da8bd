// Several devices, devices that fail, drivers whose compiler or cache fails, devices with too little memory.
#include <csignal>
#include <nlohmann/json.hpp>

#include "cli_fixture.h"
#include "host/memory_needs.h"
#include "host/world.h"

namespace wale::test {
namespace {

using Json = nlohmann::json;

/// Two of PoCL's CPU devices in one process.
const std::string kTwo = "POCL_DEVICES=basic pthread";

class CliDevices : public Cli {
 protected:
  void SetUp() override {
    Cli::SetUp();
    if (!contains(run_wale({"devices"}, {kTwo}).out, "1: pthread")) GTEST_SKIP() << "PoCL's two CPU devices are needed";
  }
  std::vector<std::string> render(const std::string& device, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> args{"render", scene_, "-o", at("old.png"), "--device", device};
    args.insert(args.end(), more.begin(), more.end());
    return args;
  }
};

TEST_F(CliDevices, NumbersThatAreNone) {
  for (const char* text : {"one", "0,", "0;1", "-1", "0,,1"})
    EXPECT_TRUE(contains(refused(render(text), 1, {kTwo}), "expected a number, numbers with commas")) << text;
  EXPECT_TRUE(contains(refused(render(""), 1, {kTwo}), "--device: the value is empty"));
  EXPECT_TRUE(contains(refused(render("0,1,0"), 1, {kTwo}), "--device 0,1,0: device 0 is named twice"));
  EXPECT_TRUE(contains(refused(render("0,7"), 1, {kTwo}), "--device 7: there is no such device; valid: 0 to 1"));
  EXPECT_FALSE(contains(run_wale(render("7"), {kTwo}).err, "knit")) << "nobody waits for a knit in vain";
  const std::string only = "--device all: only a render uses several devices; give one number, for example --device 0";
  EXPECT_TRUE(contains(refused({"plan", scene_, "--device", "all"}, 1, {kTwo}), only));
  EXPECT_TRUE(contains(refused({"bench", "--device", "all"}, 1, {kTwo}), only));
  EXPECT_TRUE(contains(refused({"bench", "--device", "one"}, 1, {kTwo}), "--device one: expected a number"));
  EXPECT_TRUE(contains(refused({"build", scene_, "--device", "all"}), "--device: no such option of `wale build`"));
}

TEST_F(CliDevices, TraversalsThatAreNone) {
  EXPECT_TRUE(contains(refused({"plan", scene_}, 1, {"WALE_TRAVERSAL=gpu"}),
                       "WALE_TRAVERSAL: gpu: expected lanes or simt, or nothing for the device's own"));
  EXPECT_TRUE(contains(run_wale({"devices"}, {"WALE_TRAVERSAL=simt"}).out, "one ray per work-item"));
  EXPECT_TRUE(contains(run_wale({"devices"}, {"WALE_TRAVERSAL=lanes"}).out, "lanes"));
}

TEST_F(CliDevices, SharesStandInTheStatistics) {
  const Outcome run = run_wale({"render", scene_, "-o", at("a.png"), "--device", "all", "--spp", "64", "--size",
                                "64x64", "--set", "integrator.pool=1024", "--stats", at("s.json")},
                               {kTwo}, 300);
  ASSERT_EQ(run.status, 0) << run.err;
  const Json s = Json::parse(file_text(folder_ / "s.json"));
  ASSERT_EQ(s["devices"].size(), 2u);
  double share = 0;
  uint64_t samples = 0, rays = 0;
  for (const auto& d : s["devices"]) {
    EXPECT_GT(d["share"].get<double>(), 0) << "each takes part";
    EXPECT_GT(d["busy_seconds"].get<double>(), 0);
    share += d["share"].get<double>(), samples += d["samples"].get<uint64_t>(), rays += d["rays"].get<uint64_t>();
  }
  EXPECT_NEAR(share, 1, 1e-12);
  EXPECT_EQ(samples, 64u * 64 * 64);
  EXPECT_EQ(s["samples"], samples);
  EXPECT_EQ(s["rays"]["all"]["count"], rays);
  double start = 0;
  for (const auto& [step, seconds] : s["start"].items()) start += seconds.get<double>();
  EXPECT_NEAR(start, s["first_sample_seconds"].get<double>(), 1e-9);
  EXPECT_GT(s["start"]["knit"].get<double>(), 0);
}

TEST_F(CliDevices, StoppedTogether) {
  const TemporaryFolder printed;
  Process process(printed.path(),
                  {"render", scene_, "-o", at("a.exr"), "--device", "all", "--size", "64x64", "--spp", "1000000"},
                  {kTwo});
  ASSERT_TRUE(process.wait_for("render ", 300)) << process.err();
  const double asked = process.seconds();
  process.signal(SIGINT);
  EXPECT_EQ(process.wait(60), 0) << process.err();
  EXPECT_LT(process.seconds() - asked, 15);
  EXPECT_TRUE(contains(process.err(), "stopped early"));
  EXPECT_EQ(read_image(folder_ / "a.exr", true).width, 64);
}

TEST_F(CliDevices, OneThatFailsInTheMiddleEndsTheRender) {
  for (const std::string which : {"basic", "pthread"}) {
    const std::string line = refused(render("all", {"--size", "64x64", "--spp", "100000"}), 2,
                                     {kTwo, std::string("LD_PRELOAD=") + FAILING_DRIVER, "FAIL_DEVICE=" + which,
                                      "FAIL_AFTER=300", "ASAN_OPTIONS=verify_asan_link_order=0"});
    EXPECT_TRUE(contains(line, which == "basic" ? "wale: device 0 (basic" : "wale: device 1 (pthread"));
    EXPECT_TRUE(contains(line, "): OpenCL: clEnqueueNDRangeKernel failed: CL_OUT_OF_RESOURCES (-5); "));
  }
}

TEST_F(CliDevices, TooLittleMemoryIsRefusedWithFigures) {
  const std::string line = refused(render("0", {"--size", "4096x4096"}), 1, {kTwo, "POCL_MEMORY_LIMIT=1"});
  EXPECT_TRUE(contains(line, "wale: device 0 (basic"));
  EXPECT_TRUE(contains(line, ") has 1.1 GB, the scene needs 2.2 GB: film 2.1 GB, path state 13.3 MB, ")) << line;
  EXPECT_TRUE(contains(line, " and less; use a film.size of at most 2048 x 2048, or another device"));
}

class Cache : public CliDevices {
 protected:
  /// `wale plan` compiles two programs only.
  Outcome plan(const TemporaryFolder& cache, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> environment{"POCL_CACHE_DIR=" + cache.path().string()};
    environment.insert(environment.end(), more.begin(), more.end());
    return run_wale({"plan", scene_}, environment);
  }
};

TEST_F(Cache, DamagedFilesAreADevicesFault) {
  const TemporaryFolder sound;
  const Outcome expected = plan(sound);
  ASSERT_EQ(expected.status, 0) << expected.err;
  // The driver aborts, meets a bus error, aborts elsewhere, or reports an error.
  for (const auto& [kind, left] : {std::pair(".so", 0), {".so", 5000}, {".bc", 5000}, {".bc", 0}}) {
    const TemporaryFolder damaged;
    std::filesystem::copy(sound.path(), damaged.path(), std::filesystem::copy_options::recursive);
    size_t files = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(damaged.path()))
      if (entry.path().extension() == kind) std::filesystem::resize_file(entry.path(), uintmax_t(left)), ++files;
    ASSERT_GT(files, 0u);
    const Outcome run = plan(damaged);
    if (run.status == 0) {  // the driver saw it
      EXPECT_EQ(run.out, expected.out);
      continue;
    }
    EXPECT_EQ(run.status, 2) << kind << " of " << left << " bytes: " << run.err;
    EXPECT_TRUE(contains(run.err, "kernel cache")) << "what to do about it";
  }
}

TEST_F(Cache, AnotherCompilerOptionIsAnotherProgram) {
  const TemporaryFolder cache;
  const Outcome first = plan(cache);
  ASSERT_EQ(first.status, 0) << first.err;
  const auto programs = [&] {
    size_t n = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(cache.path()))
      n += entry.path().filename() == "program.bc";
    return n;
  };
  const size_t before = programs();
  EXPECT_GT(before, 0u);
  ASSERT_EQ(plan(cache).status, 0);
  EXPECT_EQ(programs(), before) << "the same again comes from the cache";
  const Outcome broken = plan(cache, {"WALE_KERNEL_OPTIONS=-Dget_global_id=w_no_such_function"});
  EXPECT_EQ(broken.status, 2) << "a program of other options must not come from the cache: " << broken.err;
}

TEST_F(CliDevices, ABuildThatFailsKeepsItsLog) {
  for (const bool writable : {true, false}) {
    const TemporaryFolder cache;
    const std::string folder = writable ? cache.path().string() : "/proc/nowhere";
    // A render compiles in children too; `wale plan` in one process.
    const std::string line =
        refused(writable ? render("0") : std::vector<std::string>{"plan", scene_}, 2,
                {"WALE_KERNEL_OPTIONS=-Dget_global_id=w_no_such_function", "XDG_CACHE_HOME=" + folder,
                 "TMPDIR=" + cache.path().string(), "POCL_CACHE_DIR=" + cache.path().string() + "/pocl"});
    EXPECT_TRUE(contains(line, "does not compile for "));
    EXPECT_TRUE(contains(line, " with the environment's WALE_KERNEL_OPTIONS: "));
    EXPECT_TRUE(contains(line, "w_no_such_function")) << "the compiler's first error";
    const std::string is_in = "; the whole log is in ";
    const size_t at = line.find(is_in);
    ASSERT_NE(at, std::string::npos) << line;
    const std::string file = line.substr(at + is_in.size());
    EXPECT_TRUE(file.starts_with(cache.path().string() + "/wale/")) << file;
    const std::string log = file_text(file);
    EXPECT_TRUE(contains(log, "w_no_such_function"));
    EXPECT_TRUE(contains(log, "options: "));
  }
}

TEST(MemoryNeeds, OneBufferThatIsTooLargeIsNamed) {
  Device device = Device::open();
  World world;
  world.camera.width = world.camera.height = 64;
  Fabric fabric;
  fabric.anchors.resize(1000);
  world.fabrics.push_back(fabric);
  device.traits().max_alloc_bytes = 1000 * sizeof(WAnchor) - 1;
  auto& traits = device.traits();
  const auto needs = memory_needs(world, Features{}, 64, traits);
  const std::string line = user_message([&] { require_memory(device, needs); });
  EXPECT_TRUE(contains(line, "holds at most 0.0 MB in one buffer, warp and pack would need 0.0 MB; use fewer repeats"));
  traits.max_alloc_bytes = 1000 * sizeof(WAnchor);
  require_memory(device, needs);
}

}  // namespace
}  // namespace wale::test
