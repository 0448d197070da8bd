#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "host/scene.h"

namespace wale::cost {

/// One picture that is rendered; several levels may ask for the same.
struct Unit {
  std::string name;  ///< of the first level that asked for it
  Scene scene;
  std::string geometry;  ///< equal for units that can share a World and what lies of it on the device
  std::string settings;  ///< its level of every accuracy option
};

/// A row of the report: the scene with one option at one level, or with a preset.
struct Level {
  std::string option, level;   ///< "preset" and its name for presets
  std::optional<size_t> unit;  ///< none: it cannot be rendered
  std::string skipped;         ///< why not
  bool own = false;            ///< what the scene has anyway
  bool beyond = false;         ///< more accurate than the reference in this option
};

/// What `wale cost` compares. Unit 0 is the scene as it is, `reference` the one that all are compared with.
struct Levels {
  std::vector<Unit> units;
  std::vector<Level> rows;  ///< options in the order of their table, each from cheap to dear, then the presets
  size_t reference = 0;
};

/// Names of `--options`: accuracy options, and "presets" for those. Throws a user error with the nearest name.
struct WantedOptions {
  std::vector<std::string> options;
  bool presets = true;
};
WantedOptions wanted_options(const std::string& text);

/// Width and height of what is rendered; 0: those of the scene, made smaller until neither is above kLongestSide.
struct PictureSize {
  int width = 0, height = 0;
};
constexpr int kLongestSide = 128;

/// Reads the scene once per level. A level that the scene refuses (a lattice over a mesh that takes none) becomes a row
/// with the reason; what is wrong with the scene itself is thrown.
Levels collect_levels(const std::filesystem::path& scene, const std::vector<std::string>& set,
                      const WantedOptions& wanted, PictureSize size);

}  // namespace wale::cost
