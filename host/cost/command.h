#pragma once
#include "host/commands.h"

namespace wale {

struct CostArgs : SceneArgs {
  std::filesystem::path output;  ///< folder; made where its parent exists
  double minutes = 10;
  std::string size;
  std::filesystem::path reference;  ///< EXR of `wale render` of the same scene
  std::string options;              ///< names with commas between them; empty: all, and the presets
  std::string command;              ///< as it was typed, for the report
};

/// `wale cost`: measures what each level of each accuracy option takes and changes, and writes cost.csv, cost.json,
/// pareto.svg, pareto.png and index.html into a folder.
int run_cost(const CostArgs& args, const Loaders& loaders);

}  // namespace wale
