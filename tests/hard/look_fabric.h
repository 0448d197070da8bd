#pragma once
// Measurements of a fabric's geometry that the mesh traps share.
#include <string>

#include "host/world.h"
#include "tests/hard/trap.h"

namespace wale::test {

/// How the device's exact stage and every segment in double, one after the other, see the same rays.
struct Agreement {
  uint64_t rays = 0, hits = 0;
  uint64_t grazing = 0;  ///< they part where the ray grazes a ply or the very edge of a joint, |h| > 0.999
  uint64_t wrong = 0;    ///< they part elsewhere
  double worst = 0;      ///< |dt| of the others, ply radii
};
Agreement compare_with_brute_force(const Fabric& fabric, size_t rays);

/// Rays along `direction` on a square of `size` metres about `target` that meet no ply.
uint64_t rays_that_pass(const Fabric& fabric, dvec3 target, dvec3 direction, double size, int across);

}  // namespace wale::test
