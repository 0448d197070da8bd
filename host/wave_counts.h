#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <string>

#include "host/device.h"
#include "shared/wale_types.h"

namespace wale {

/// Seconds and launches of one kernel, by the device's clock unless said, and the items that it worked on: paths, hits,
/// rays.
struct StageTime {
  double seconds = 0;
  size_t launches = 0;
  uint64_t items = 0;
};

/// What the wavefront counted. Of several devices: sums, seconds too; the longest path of all.
struct WaveCounts {
  uint64_t primary = 0, bounce = 0, shadow = 0, paths = 0;
  uint32_t deepest = 0;
  std::array<uint32_t, W_EVENT_COUNT> events{};
  std::map<std::string, StageTime> stages;  ///< by kernel
  double primary_seconds = 0;               ///< what the nearest hits of camera rays took
  std::map<std::string, double> program_seconds;

  /// What the nearest hits of all other rays took.
  double bounce_seconds() const;

  WaveCounts& operator+=(const WaveCounts& other);
  /// Items of one bounce of `live` paths, whose hits the kernel `nearest` found. `hits` are the bins after it: plies,
  /// surfaces, misses, fibres.
  void add_bounce(const std::string& nearest, uint32_t live, const uint32_t* hits, uint32_t shadow_rays);
  /// Items of the stages that every path of a wave goes through once.
  void add_wave(uint32_t wave_paths);
  /// A launch that is over.
  void add_launch(const std::string& kernel, double launch_seconds, bool camera_rays);
};

/// Seconds from start to end of a command of a profiling queue, by the device's clock.
double device_seconds(const cl::Event& event);

}  // namespace wale
