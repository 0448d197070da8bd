#pragma once
#include "host/surface_set.h"

namespace wale {

/// Adds a scene's lights to a world whose origin is known: what they are made of to `surfaces`, the rest to the world.
/// `radius`, metres: of everything that the environment lights. `kept_before`: meshes of an earlier version, or null.
void add_lights(World& world, SurfaceSet& surfaces, const Scene& scene, const Loaders& loaders, double radius,
                const KeptMeshes* kept_before);

}  // namespace wale
