#pragma once
#include <cstdint>
#include <string>

namespace wale {

/// What the command line of `goniometer` says.
struct Options {
  int64_t paths = 30000;
  int sections = 8;
  uint64_t seed = 1;
  std::string preset, output;
};

/// `goniometer table`: published bundles, measured again.
void print_table(const Options& options);

}  // namespace wale
