// The benchmark: what it reports, that wrong hits and wrong pictures cost it its figures, what it refuses.
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "bench/wale_bench/report.h"
#include "tests/host/cli_fixture.h"
#include "tests/tolerances.h"

namespace wale::test {
namespace {

using Json = nlohmann::json;
using bench::CheckedRay;

const Device& device() {
  static const Device opened = Device::open();
  return opened;
}

// Rays of a small cloth through the plies that they were recorded with.
class BenchRays : public testing::Test {
 protected:
  BenchRays() : workload_(bench::cloth_workload(2000, 1024)), world_(build_world(workload_.scene, {})) {}

  void SetUp() override {
    RenderOptions options;
    options.spp = 1;
    options.record = &record_;
    options.pool = 1024;
    render(device(), world_, scene_, workload_.scene.integrator, options);
    ASSERT_FALSE(record_.batches.empty());
  }

  std::vector<CheckedRay> primary(const bench::Oracle& oracle) const {
    return oracle.sample(record_.batches.front(), record_.batches.front().found, 200);
  }

  bench::Workload workload_;
  World world_;
  SceneDevice scene_{device(), world_};
  RayRecord record_;
};

TEST_F(BenchRays, ReplayFindsWhatTheRenderFoundBitForBit) {
  Wavefront wavefront(device(), scene_, analyse(world_, workload_.scene.integrator, false, device().traits()),
                      world_.camera, 1024);
  std::array<size_t, 3> batches{};
  for (const RayBatch& batch : record_.batches) {
    ++batches[size_t(batch.kind)];
    if (batch.kind == RayKind::shadow) continue;
    wavefront.load(batch);
    EXPECT_GT(wavefront.trace_loaded(batch), 0);
    const auto found = wavefront.read_found(batch);
    ASSERT_EQ(found.size(), batch.found.size());
    EXPECT_EQ(std::memcmp(found.data(), batch.found.data(), found.size() * sizeof(w_float4)), 0)
        << "depth " << batch.depth;
  }
  for (const size_t n : batches) EXPECT_GT(n, 0u);
}

TEST_F(BenchRays, OracleAgreesWithTheDevice) {
  const bench::Oracle oracle(device(), world_, scene_.fabric(), false);
  const auto rays = primary(oracle);
  ASSERT_GE(rays.size(), 150u);
  size_t hits = 0;
  for (const CheckedRay& r : rays) hits += r.kind == W_HIT_PLY;
  EXPECT_GT(hits, rays.size() / 5);
  const auto agreement = oracle.check(rays);
  EXPECT_EQ(agreement.checked, rays.size());
  EXPECT_TRUE(agreement.passes()) << agreement.agree;
}

TEST_F(BenchRays, WrongHitsAreNotVerified) {
  const bench::Oracle oracle(device(), world_, scene_.fabric(), false);
  const auto passes = [&](const auto& mutate) {
    auto rays = primary(oracle);
    for (CheckedRay& r : rays)
      if (r.kind == W_HIT_PLY) mutate(r);
    return oracle.check(rays).passes();
  };
  EXPECT_TRUE(passes([](CheckedRay&) {}));
  EXPECT_FALSE(passes([](CheckedRay& r) { r.t *= 1.001f; })) << "another distance";
  EXPECT_FALSE(passes([](CheckedRay& r) { r.segment += 5; })) << "another segment";
  EXPECT_FALSE(passes([](CheckedRay& r) { r.kind = W_HIT_NONE; })) << "missed";
  EXPECT_FALSE(passes([](CheckedRay& r) { r.ray.key += 1; })) << "another choice of what lets the ray pass";
  for (const RayBatch& batch : record_.batches)
    if (batch.kind == RayKind::shadow) {
      // The shadow rays' results are unknown here: all blocked, or none, cannot both be right.
      auto rays = oracle.sample(batch, std::vector<w_float4>(batch.slots.size()), 100);
      const bool all = oracle.check(rays).passes();
      for (CheckedRay& r : rays) r.blocked = false;
      EXPECT_FALSE(all && oracle.check(rays).passes());
      break;
    }
}

TEST(BenchReport, WhatDoesNotVerifyHasNoSpeed) {
  bench::BenchReport report;
  report.device = device().traits();
  report.rates = {1e10, 1e11, 1 << 20};
  bench::RayRow row;
  row.rays = 1000;
  row.device = {1e-3};
  row.cpu = {2e-3};
  row.agreement = {100, 100};
  report.fabrics.emplace_back();
  report.fabrics[0].name = "cloth";
  report.fabrics[0].rays = {row};
  EXPECT_TRUE(report.verified());
  Json rays = Json::parse(bench::report_json(report).dump())["fabrics"][0]["rays"][0];
  EXPECT_DOUBLE_EQ(rays["mrays_per_second"], 1);
  EXPECT_DOUBLE_EQ(rays["mrays_per_cpu_second"], 0.5);

  report.fabrics[0].rays[0].agreement.agree = 98;
  EXPECT_FALSE(report.verified());
  EXPECT_TRUE(contains(report.failure(), "cloth: primary rays: 2 of 100 differ"));
  rays = Json::parse(bench::report_json(report).dump())["fabrics"][0]["rays"][0];
  EXPECT_TRUE(rays["mrays_per_second"].is_null());
  EXPECT_FALSE(rays["verified"]);
  EXPECT_TRUE(contains(bench::report_text(report), "not verified"));
  EXPECT_TRUE(contains(bench::report_csv(report), ",1000,,,"));

  report.fabrics[0].rays[0].agreement.agree = 100;
  report.fabrics[0].rays[0].repeats = false;
  EXPECT_TRUE(contains(report.failure(), "not the same hits"));
}

TEST(BenchPicture, FrozenWorkloadLooksAsItDid) {
  const auto& reference = bench::reference_picture();
  ASSERT_EQ(reference.mean.size(), 3u * 36u);
  bench::TileMeans tiles = bench::render_picture(device(), 0, 0, {});
  const auto check = bench::compare_tiles(reference, tiles);
  EXPECT_TRUE(check.same) << check.largest_z << " standard errors, mean square " << check.mean_z2;
  EXPECT_GT(check.mean_z2, 0.1) << "errors so large say nothing";
  for (float& v : tiles.mean) v *= 1.02f;
  EXPECT_FALSE(bench::compare_tiles(reference, tiles).same) << "two per cent brighter";
  for (float& v : tiles.mean) v /= 1.02f;
  std::swap(tiles.mean[3 * 14], tiles.mean[3 * 15 + 2]);
  EXPECT_FALSE(bench::compare_tiles(reference, tiles).same) << "one tile's red is its neighbour's blue";
  tiles.mean[0] = NAN;
  EXPECT_FALSE(bench::compare_tiles(reference, tiles).same);
}

class CliBench : public Cli {};

TEST_F(CliBench, ReportOfASmallCloth) {
  const Outcome run = run_wale({"bench", "--sizes", "2k", "--rays", "1024", "--repeats", "1", "--quiet", "--json",
                                at("b.json"), "--csv", at("b.csv")});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_TRUE(contains(run.out, "attenuated shadow"));
  const Json b = Json::parse(file_text(folder_ / "b.json"));
  EXPECT_EQ(b["schema"], bench::kSchema);
  EXPECT_TRUE(b["verified"]);
  EXPECT_TRUE(b["score"].is_null());
  for (const char* key : {"name", "driver", "platform"}) EXPECT_FALSE(b["device"][key].get<std::string>().empty());
  for (const char* key : {"bytes_per_second", "operations_per_second"}) EXPECT_GT(b["rates"][key], 1e6) << key;
  const Json& f = b["fabrics"].at(0);
  EXPECT_NEAR(f["segments"].get<double>(), 2000, 200);
  EXPECT_GT(f["bytes_per_segment"]["trace"], 0);
  EXPECT_GT(f["bytes_per_segment"]["shade"], f["bytes_per_segment"]["trace"]);
  for (const char* key : {"knit_seconds", "warp_seconds", "pack_seconds", "tree_seconds"}) EXPECT_GT(f[key], 0) << key;
  ASSERT_EQ(f["rays"].size(), 6u);
  for (const Json& row : f["rays"]) {
    EXPECT_GE(row["checked"], 64) << row;
    EXPECT_GT(row["mrays_per_second"], 0) << row;
    // Rays of a packet share their visits.
    EXPECT_GT(row["nodes_per_ray"], row["kind"] == "primary" ? 1.0 / W_NODE_WIDTH : 1.0) << row;
    EXPECT_GT(row["leaves_per_ray"], 0.1) << row;
    EXPECT_GT(row["bytes_per_ray"], row["nodes_per_ray"].get<double>() * 100) << row;
  }
  EXPECT_EQ(f["rays"][0]["kind"], "primary");
  EXPECT_EQ(f["rays"][0]["rays"], 1024);
  EXPECT_TRUE(f["rays"][5]["attenuated"]);
  for (const char* kind : {"primary", "bounce", "shadow"})
    EXPECT_GT(f["render"]["replay_over_render"][kind], 0) << kind;
  EXPECT_GT(f["render"]["samples_per_second"], 0);
  for (const Json& stage : f["stages"])
    if (stage["stage"] == "intersect") {
      EXPECT_GT(stage["operations_per_item"], 0);
      EXPECT_GT(stage["bytes_per_item"], 1000) << "the tree's bytes are in it";
      EXPECT_GT(stage["floor_ns"], 0);
    }
  std::ifstream csv(folder_ / "b.csv");
  size_t lines = 0;
  for (std::string line; std::getline(csv, line);) ++lines;
  EXPECT_EQ(lines, 7u);
}

TEST_F(CliBench, RaysOfAScene) {
  const Outcome run =
      run_wale({"bench", "--scene", scene_, "--repeats", "1", "--rays", "512", "--quiet", "--json", "-"});
  ASSERT_EQ(run.status, 0) << run.err;
  const Json b = Json::parse(run.out);
  EXPECT_EQ(b["fabrics"][0]["name"], scene_);
  EXPECT_TRUE(b["verified"]);
}

TEST_F(CliBench, RefusesBadWords) {
  EXPECT_TRUE(contains(refused({"bench", "--sizes", "0.1Q"}), "--sizes 0.1Q: expected a number of segments"));
  EXPECT_TRUE(contains(refused({"bench", "--sizes", "10"}), "from 1k to 1000M"));
  EXPECT_TRUE(contains(refused({"bench", "--sizes", "nan"}), "--sizes nan"));
  EXPECT_TRUE(contains(refused({"bench", "--sizes", "1k", "--scene", scene_}), "give one of the two"));
  EXPECT_TRUE(contains(refused({"bench", "--set", "film.size=[2,2]"}), "needs --scene"));
  EXPECT_TRUE(contains(refused({"bench", "--repeats", "0"}), "--repeats"));
  EXPECT_TRUE(contains(refused({"bench", "--json", at("none/b.json")}), "none"));
  EXPECT_TRUE(contains(refused({"bench", "--jsn", "x"}), "--json"));
  EXPECT_TRUE(contains(refused({"bench", "--scene", at("none.json")}), "none.json"));
  refused({"bench", "--sizes", "1k"}, 2, {kNoDevice});
}

// On a machine with a driver and nothing else.
TEST(BenchProgram, LinksTheLoaderAlone) {
  std::FILE* pipe = popen("ldd " WALE_BENCH_PROGRAM, "r");
  ASSERT_NE(pipe, nullptr);
  char line[512];
  size_t libraries = 0;
  while (std::fgets(line, sizeof line, pipe)) {
    const std::string text = line;
    const auto is = [&](const char* name) { return text.find(name) != std::string::npos; };
    EXPECT_TRUE(is("libOpenCL.so") || is("libc.so") || is("libm.so") || is("vdso") || is("ld-linux") || is("san.so"))
        << text;
    ++libraries;
  }
  EXPECT_EQ(pclose(pipe), 0);
  EXPECT_GE(libraries, 3u);
}

}  // namespace
}  // namespace wale::test
