#pragma once
#include <cstdint>
#include <string>

namespace wale {

/// What the command line of `goniometer` says.
struct Options {
  int64_t paths = 30000;
  int sections = 8;
  uint64_t seed = 1;
  std::string bundle;  ///< preset or file
  std::string output;  ///< folder, empty: nothing is written
};

/// `goniometer table`: published bundles, measured again.
void print_table(const Options& options);

/// `goniometer fit BUNDLE`: measures, fits, writes BUNDLE.json (a material) and BUNDLE_compared.json (for plot.py).
void fit_bundle(const Options& options);

}  // namespace wale
