#include "bench/wale_bench/command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "bench/wale_bench/report.h"
#include "geom/error.h"
#include "host/atomic_file.h"
#include "host/progress.h"

namespace wale::bench {
namespace {

constexpr int kReferenceSamples = 1024;
constexpr uint32_t kReferenceSeed = 1;  // not the seed of those who compare with it
constexpr double kLeastSegments = 1000, kMostSegments = 1e9;

void write(const std::filesystem::path& file, const std::string& text) {
  if (file == "-")
    fmt::print("{}", text);
  else if (!file.empty())
    write_text_file(file, text);
}

// As many as fill the device, and enough to be timed.
constexpr uint64_t kLeastRays = 512 * 512;

std::vector<Workload> workloads_of(const BenchArgs& args, uint32_t pool) {
  const uint64_t rays = args.rays ? args.rays : std::max<uint64_t>(pool, kLeastRays);
  std::vector<Workload> out;
  if (!args.scene.empty()) out.push_back(scene_workload(read_scene(args.scene, args.set), rays));
  for (const std::string& size : args.sizes) out.push_back(cloth_workload(parse_size(size), rays));
  if (out.empty()) out.push_back(frozen_workload(pool));
  return out;
}

}  // namespace

double parse_size(const std::string& text) {
  char* end = nullptr;
  double value = std::strtod(text.c_str(), &end);
  const std::string unit = end;
  if (unit == "M") value *= 1e6;
  if (unit == "k") value *= 1e3;
  if (end == text.c_str() || !(unit.empty() || unit == "M" || unit == "k") || !(value >= kLeastSegments) ||
      !(value <= kMostSegments))
    user_error("--sizes {}: expected a number of segments from 1k to 1000M, for example 0.1M", text);
  return value;
}

int run_bench(const BenchArgs& args, const Loaders& loaders) {
  if (!args.scene.empty() && !args.sizes.empty()) user_error("--scene and --sizes: give one of the two");
  if (args.scene.empty() && !args.set.empty()) user_error("--set {}: needs --scene", args.set.front());
  for (const auto& file : {args.json, args.csv, args.reference})
    if (!file.empty() && file != "-") require_writable_path(file);
  const Device device = Device::open(one_device_number(args.device));
  if (!args.reference.empty()) {
    write(args.reference, reference_source(render_picture(device, kReferenceSamples, kReferenceSeed, args.kernel_dir),
                                           device.traits().name));
    return 0;
  }
  BenchReport report;
  report.device = device.traits();
  report.repeats = args.repeats;
  const std::vector<Workload> workloads = workloads_of(args, device.traits().pool);
  report.rates = measure_rates(device);
  MeasureOptions options;
  options.repeats = args.repeats;
  options.kernel_dir = args.kernel_dir;
  if (args.every_feature) options.also = Features::everything();
  for (const Workload& workload : workloads) {
    Progress bar(workload.name, args.quiet);
    report.fabrics.push_back(
        measure(device, workload, loaders, report.rates, options, [&](double share) { bar.update(share); }));
    bar.finish();
    if (workload.frozen) report.score = score_of(device, report.fabrics.back(), check_picture(device, args.kernel_dir));
  }
  write(args.json, report_json(report).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
  write(args.csv, report_csv(report));
  if (args.json != "-" && args.csv != "-") fmt::print("{}", report_text(report));
  if (!report.verified()) device_error("bench: {}", report.failure());
  return 0;
}

}  // namespace wale::bench
