#pragma once
// The options of `wale bench` and of wale_bench, the same words in both.
#include <CLI/CLI.hpp>

#include "bench/wale_bench/command.h"

namespace wale::bench {

inline void add_bench_options(CLI::App& command, BenchArgs& args) {
  command.add_option("--sizes", args.sizes, "cloths of so many segments, for example 0.1M,1M; default: the score")
      ->delimiter(',');
  command.add_option("--scene", args.scene, "the rays of this scene instead");
  command.add_option("--set", args.set, "change a key of the scene: key.path=value (repeatable)")
      ->allow_extra_args(false);
  command.add_option("--rays", args.rays, "camera rays of sizes and scenes; default: as many as fill the device")
      ->check(CLI::Range(64, 1 << 24));
  command.add_option("--repeats", args.repeats, "repeats, of which medians are given")->check(CLI::Range(1, 1000));
  command.add_option("--device", args.device, "number of the OpenCL device, see `wale devices`");
  command.add_option("--json", args.json, "write everything as JSON (- for the terminal)");
  command.add_option("--csv", args.csv, "write the rows of rays as CSV (- for the terminal)");
  command.add_option("--kernel-dir", args.kernel_dir, "read kernels from this folder instead of the built-in ones");
  command.add_option("--write-reference", args.reference, "write the reference picture of the frozen workload");
  command
      .add_option_function<std::string>(
          "--features", [&args](const std::string& word) { args.every_feature = word == "all"; },
          "what is built into the kernels: needed (what a scene calls for, the default) or all")
      ->check(CLI::IsMember({"needed", "all"}));
  command.add_flag("--quiet", args.quiet, "no progress");
}

}  // namespace wale::bench
