#pragma once
#include <vector>

#include "host/scene.h"

namespace wale {

/// What the controls of a fabric need of its tile, which is read once.
struct TileFacts {
  dvec2 period{1, 1};  ///< metres
  ivec2 stitches{1, 1};
  std::vector<Rgb> palette;  ///< of its yarns; empty where the tile gives none
};

TileFacts tile_facts(const FabricScene& fabric);

}  // namespace wale
