#pragma once
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace wale {

struct Scene;

/// One level of an accuracy option: what it sets in a scene, as `--set` takes it.
struct AccuracyLevel {
  std::string name;
  std::vector<std::string> overrides;  ///< "key.path=value"; "*" in a path: every element of that list
};

/// A choice between ways of doing the same. Levels go from the plainest to the most accurate, which the others are
/// measured against; plainer is not always cheaper (bench/results/prices.md).
struct AccuracyOption {
  std::string name;
  std::string doc;
  std::vector<AccuracyLevel> levels;
  std::string (*at)(const Scene&);  ///< name of the scene's level, or its value between levels, or "mixed"

  const AccuracyLevel& most_accurate() const { return levels.back(); }
  /// Null where no level has this name.
  const AccuracyLevel* level(const std::string& wanted) const;
};

/// What an option stands at where only plies know of it and a scene has none.
constexpr const char* kNoFabric = "no fabric";

/// All of them, in the order in which they are reported.
std::span<const AccuracyOption> accuracy_options();

/// A named bundle: a level of every option that does not depend on how a fabric is held.
struct AccuracyPreset {
  std::string name;
  std::string doc;
  std::vector<std::pair<std::string, std::string>> levels;  ///< option and its level, in the order of the options

  /// Those of its levels, to be applied before any that the user gives.
  std::vector<std::string> overrides() const;
};

/// draft, paper, final, reference: from the cheapest to the most accurate.
std::span<const AccuracyPreset> accuracy_presets();

/// Their names, separated by commas.
std::string preset_names();

/// The preset of this name; a user error that lists them where there is none.
const AccuracyPreset& accuracy_preset(const std::string& name);

/// The option of this name; a user error with the nearest one where there is none.
const AccuracyOption& accuracy_option(const std::string& name);

}  // namespace wale
