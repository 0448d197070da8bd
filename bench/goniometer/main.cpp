// Virtual goniometer: measures how bundles of fibres scatter, and fits the ply's parameters to that.
#include <CLI/CLI.hpp>
#include <cstdio>

#include "bench/goniometer/commands.h"
#include "geom/error.h"

int main(int argc, char** argv) {
  CLI::App app{"Virtual goniometer of fibre bundles"};
  app.require_subcommand(1);
  wale::Options options;
  const auto common = [&](CLI::App* command) {
    command->add_option("--paths", options.paths, "paths per measurement")->capture_default_str();
    command->add_option("--sections", options.sections, "cross-sections they are shared between")
        ->capture_default_str();
    command->add_option("--seed", options.seed)->capture_default_str();
  };
  CLI::App* table = app.add_subcommand("table", "published bundles, measured again");
  common(table);
  CLI::App* fit = app.add_subcommand("fit", "parameters of a ply from its fibres");
  common(fit);
  fit->add_option("bundle", options.bundle, "a ply preset, or a JSON file of a ply material with fibres")->required();
  fit->add_option("-o,--output", options.output, "folder for the material and the comparison");
  CLI11_PARSE(app, argc, argv);
  try {
    if (*table) wale::print_table(options);
    if (*fit) wale::fit_bundle(options);
  } catch (const wale::Error& e) {
    std::fprintf(stderr, "goniometer: %s\n", e.what());
    return int(e.fault());
  }
  return 0;
}
