#pragma once
#include <string>

#include "host/scene.h"

namespace wale {

/// All that a knitted fabric follows from. What is not in it (colours, gloss, lights, camera) may change without a
/// stitch being knitted again.
struct KnitOrder {
  MeshSource mesh;
  Transform transform;
  PatternSource pattern;
  FabricSpec spec;       ///< with what its material and the integrator ask for
  std::string obstacle;  ///< why nothing in the scene may be a lattice; empty: it may

  bool operator==(const KnitOrder&) const = default;
};

/// True where `made`, knitted to the order `before`, is what `wanted` would knit.
bool serves(const KnitOrder& before, const Fabric& made, const KnitOrder& wanted);

}  // namespace wale
