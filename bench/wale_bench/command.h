#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "host/world.h"

namespace wale::bench {

/// Options of `wale bench` and of wale_bench.
struct BenchArgs {
  std::vector<std::string> sizes;  ///< segments, "0.1M"; empty and no scene: the frozen workload
  std::filesystem::path scene;
  std::vector<std::string> set;
  int repeats = 5;
  uint64_t rays = 0;         ///< camera rays of sizes and scenes; 0: as many as fill the device
  std::string device = "0";  ///< as one_device_number() reads it
  std::filesystem::path json, csv, kernel_dir;
  std::filesystem::path reference;  ///< writes the frozen workload's picture there instead
  bool quiet = false;
  bool every_feature = false;  ///< programs with everything built in
};

/// Measures, prints a table and writes what was asked for. Throws a device error, after everything is written, when
/// something did not verify. Returns the exit status.
int run_bench(const BenchArgs& args, const Loaders& loaders);

/// "100000", "0.1M", "250k": numbers of segments. Throws a user error.
double parse_size(const std::string& text);

}  // namespace wale::bench
