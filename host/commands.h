#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "geom/chart/knit_tile.h"
#include "host/features.h"
#include "host/world.h"

namespace wale {

/// Options that several commands share.
struct SceneArgs {
  std::filesystem::path scene;
  std::vector<std::string> set;
  std::string preset;        ///< of accuracy (host/accuracy.h), applied before `set`; empty = the scene's own
  std::string device = "0";  ///< as device_numbers() reads it
  std::filesystem::path kernel_dir;
  bool quiet = false;
  Features also;  ///< built into the programs beside what the scene calls for
};

struct RenderArgs : SceneArgs {
  std::vector<std::filesystem::path> outputs;
  int spp = 0;
  double error = 0, seconds = 0;  ///< goals; 0: not set
  std::string size;
  std::filesystem::path stats;
  std::string frames;           ///< as frame_range() reads it; empty: the one that the scene shows
  bool redo = false;            ///< frames of other settings are written over
  std::filesystem::path video;  ///< empty: none
};

struct KnitArgs {
  std::filesystem::path chart, output, json;
  KnitSettings settings;
  double loop_diameters = 0;  ///< in place of settings.loop_length; 0: not given
  std::string period;  ///< "WIDTHxHEIGHT" in millimetres; empty: free
  bool quiet = false;
};

/// Puts "WIDTHxHEIGHT" into the film's size; throws a user error for anything else.
void apply_size(const std::string& size, FilmScene& film);

/// Samples per pixel at most: a goal decides itself where to stop.
int most_samples(const RenderArgs& args, const IntegratorScene& integrator);

/// Those of the preset, then those of --set.
std::vector<std::string> overrides_of(const SceneArgs& args);

/// The scene of a command, with its overrides.
Scene read_scene(const SceneArgs& args);

/// The commands of the program; each returns the exit status 0 or throws an Error.
int run_render(const RenderArgs& args, const Loaders& loaders);
int run_build(const SceneArgs& args, const std::filesystem::path& json, const Loaders& loaders);
int run_plan(const SceneArgs& args, const std::filesystem::path& json, const Loaders& loaders);
int run_export(const SceneArgs& args, const std::filesystem::path& output, const Loaders& loaders);
/// Writes the relaxed tile of a chart. Throws a user error, and writes nothing, where it cannot be relaxed.
int run_knit(const KnitArgs& args);
int run_compare(const std::filesystem::path& a, const std::filesystem::path& b, double max_rmse);
int run_devices();
int run_schema();

}  // namespace wale
