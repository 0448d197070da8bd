#pragma once
// Rays against plies, measured: what the device answers against every segment one after the other.
#include <optional>
#include <string>
#include <vector>

#include "host/scene.h"
#include "tests/hard/fixtures_curves.h"
#include "tests/hard/trap.h"

namespace wale::test {

/// Rays on one set of plies.
struct RayCase {
  Strands strands;
  std::vector<Ray> rays;
};

/// Traces the rays of all cases, in float and in double, and compares with the oracle, which has the same float inputs.
/// Errors are the largest of, in ply radii: distance of the hit from the ply's true surface; distance of the hit from
/// the ray; and where the ray crosses the surface steeply, of t beyond the rounding of t itself. `broken` names the
/// first ray whose answer (hit, miss, which segment) is wrong although neither a silhouette nor a joint's edge is near.
Finding look_at_rays(const std::vector<RayCase>& cases);

/// The same for one set of plies seen from several places: rays aimed from 8 radii, and what leaves their hits.
Finding look_at_curve(const Strands& strands, uint32_t seed);

/// A picture of white plies in a white furnace: error is how far the mean is from 1; broken when a pixel is not 1
/// within its noise, or a rare event happened that is more than a note.
Finding look_at_furnace(const Scene& scene, int spp);

/// The worse of both in every respect.
Finding worse(const Finding& a, const Finding& b);

}  // namespace wale::test
