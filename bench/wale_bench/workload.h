#pragma once
#include <cstdint>
#include <string>

#include "host/scene.h"

namespace wale::bench {

/// A scene to measure: its film and samples say which rays are sent.
struct Workload {
  std::string name;
  Scene scene;
  bool frozen = false;  ///< the versioned one that a score is given for
};

/// Version of the frozen workload. It changes whenever anything below, the geometry it knits or the look of its yarn
/// changes on purpose: figures compare within one version only.
inline constexpr const char* kFrozenName = "wale-bench v1";

/// The frozen workload: a square of stockinette draped over a ball, about a million segments of 3 plies, 28 a stitch
/// and ply, in a sky and a round lamp; 512 x 512 pixels, unlimited depth. `pool` paths in flight decide the samples per
/// pixel, 1 to 16, so that a launch fills the device; rates are per ray.
Workload frozen_workload(uint32_t pool);

/// The same cloth with about `segments` segments (its area follows) seen whole by about `rays` camera rays.
/// Throws a user error where it cannot be knitted.
Workload cloth_workload(double segments, uint64_t rays);

/// A scene of the user's, its film made smaller where that and 8 samples a pixel are more than `rays` camera rays.
Workload scene_workload(const Scene& scene, uint64_t rays);

/// The frozen workload as a small picture for the check of its look: 48 x 48 pixels.
Scene frozen_picture_scene();

}  // namespace wale::bench
