#pragma once
// Measurements of pictures that the traps of whole scenes share.
#include "tests/hard/trap.h"
#include "tests/image/picture.h"

namespace wale::test {

/// Renders the scene and compares every pixel with `expected`: error = |mean of the picture - expected| / expected,
/// broken when a pixel lies outside its own noise (one family of tests at tolerance::kFamilyP) or is not finite, or
/// when no path met anything. Trials are paths; rare events are those that are no mere notes (host/rare_events.h).
Finding look_at_constant(const Scene& scene, double expected, int spp);

/// Counts what is not finite in the colours of a picture, and the rare events.
Finding look_for_finite(const Picture& picture);

/// Two pictures of the same seed: error = RMS of their difference over RMS of their noise, broken when any pixel
/// differs by more than its noise.
Finding look_at_difference(const Picture& a, const Picture& b);

/// One finding for several looks: the largest error, the sum of trials and rare events, all that is broken.
Finding worst_of(const std::vector<Finding>& all);

}  // namespace wale::test
