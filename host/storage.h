#pragma once
#include <string>

#include "geom/fabric.h"

namespace wale {

/// Segments from which an automatic fabric that can be is held procedurally: from about here on its stored leaves are
/// larger than caches, and reading them costs more than the warp (bench/results/procedural.md).
constexpr size_t kProceduralFrom = 10'000'000;

/// How a fabric is held, and why.
struct StorageChoice {
  Storage storage = Storage::stored;  ///< stored or procedural
  bool lattice = false;               ///< warped by a lattice, not by the mesh
  std::string because;
};

/// `whole_scene_obstacle`: why nothing in this scene can be held as a lattice; empty when it can. Throws a user error
/// where the scene asks for what cannot be.
StorageChoice choose_storage(const BaseMesh& mesh, const Pattern& pattern, const FabricSpec& spec,
                             const std::string& whole_scene_obstacle);

}  // namespace wale
