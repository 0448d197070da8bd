#pragma once
#include <optional>

#include "host/commands.h"

namespace wale {

/// Lengths in millimetres, or in pixels where `scale` is given; angles in degrees.
struct MeasureArgs : SceneArgs {
  std::string fabric;           ///< by name or number; empty: the scene's only one
  std::optional<double> scale;  ///< pixels per millimetre
  std::optional<double> wale, course, yarn, ply, angle;
  std::optional<int> plies;
};

/// Turns what was measured on a picture of the cloth into options for its scene, and for a tile of its own.
int run_measure(const MeasureArgs& args, const Loaders& loaders);

}  // namespace wale
