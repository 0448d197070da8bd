#include "host/storage.h"

#include <fmt/format.h>

#include "geom/error.h"
#include "geom/lattice_fabric.h"

namespace wale {

StorageChoice choose_storage(const BaseMesh& mesh, const Pattern& pattern, const FabricSpec& spec,
                             const std::string& whole_scene_obstacle) {
  const bool asked = spec.lattice > 0 || spec.storage == Storage::procedural;
  if (!asked && spec.storage == Storage::stored) return {Storage::stored, false, "storage is \"stored\""};
  const bool large = spec.storage == Storage::automatic && estimate_segments(mesh, pattern, spec) >= kProceduralFrom;
  if (!asked && !large)
    return {Storage::stored, false, fmt::format("fewer than {:.0e} segments", double(kProceduralFrom))};
  const std::string why = whole_scene_obstacle.empty() ? lattice_obstacle(mesh, pattern, spec) : whole_scene_obstacle;
  if (!why.empty()) {
    if (asked)
      user_error("fabric \"{}\": a lattice cannot hold it: {}; give \"storage\": \"stored\" and no \"lattice\"",
                 spec.name, why);
    return {Storage::stored, false, why};
  }
  if (large || spec.storage == Storage::procedural)
    return {Storage::procedural, true,
            large ? fmt::format("{:.0e} segments or more", double(kProceduralFrom)) : "storage is \"procedural\""};
  return {Storage::stored, true, "lattice is given"};
}

}  // namespace wale
