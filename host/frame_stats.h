#pragma once
#include <filesystem>
#include <vector>

#include "host/live_scene.h"
#include "host/render.h"

namespace wale {

/// What the frames of an animation cost: `--stats FILE` with --frames.
struct FrameStats {
  struct Row {
    double frame = 0;
    size_t knitted = 0, uploaded = 0, moved = 0;  ///< versions of the scene, one a moment: fabrics knitted, or ...
    double update_seconds = 0;                    ///< from the scene of the frame to its geometry on the devices
    double host_seconds = 0, warp_seconds = 0, refit_seconds = 0;  ///< of them: on the host; of fabrics that moved
    double first_ray_seconds = 0;                                  ///< from then until the first wave was done
    double trace_seconds = 0, write_seconds = 0;
    double samples_per_pixel = 0;
    uint64_t rays = 0, resident_bytes = 0;

    void add(const Redone& redone, const FabricDevice& fabrics, double seconds);
    void add(const Rendered& rendered);
  };
  std::vector<Row> rows;

  /// Writes them as JSON, atomically.
  void write(const std::filesystem::path& file) const;
};

/// Resident size of this process now, bytes.
uint64_t resident_memory_bytes();

}  // namespace wale
