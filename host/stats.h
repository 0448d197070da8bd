#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "host/sampling_report.h"
#include "host/stage_profile.h"

namespace wale {

/// What a run did and what it cost; `--stats FILE` writes it as JSON.
struct Stats {
  struct Program {
    std::string name;
    double build_seconds = 0;
    bool cached = false;
  };
  struct Rays {
    uint64_t count = 0;
    double seconds = 0;  ///< of the launches that traced them
  };
  /// One of the devices that shared a render.
  struct DeviceWork {
    std::string name, driver;
    unsigned number = 0;
    uint64_t samples = 0, rays = 0, moved_blocks = 0;
    double busy_seconds = 0;
  };
  struct Geometry {
    uint64_t count = 0, bytes = 0;
  };

  std::string scene, device, driver, platform, kernel_options;
  std::vector<DeviceWork> devices;
  std::vector<std::string> features;
  std::vector<Program> programs;
  std::map<std::string, Geometry> geometry;     ///< "segments", "triangles", ...
  std::map<std::string, double> stage_seconds;  ///< "knit", "build tree", "intersect", ...
  std::vector<StageProfile> stages;             ///< of the wavefront; the tree's bytes are not in them
  DeviceRates rates;                            ///< by which their floors were found
  double ns_per_vertex = 0;                     ///< of all stages, per vertex of a path
  std::map<std::string, Rays> rays;             ///< "primary", "shadow", "bounce"
  std::map<std::string, uint64_t> rare_events;  ///< "depth limit", ...
  int width = 0, height = 0;
  uint64_t samples = 0;  ///< paths
  double samples_per_pixel = 0;  ///< mean
  SamplingReport sampling;
  double total_seconds = 0;
  /// Wall seconds from the start of the program to the first finished wave, and what they are made of, in order.
  double first_sample_seconds = 0;
  std::vector<std::pair<std::string, double>> start;

  /// Indented JSON. A rate whose time was not measured is null; numbers that are not finite too.
  std::string json() const;
};

/// Largest resident size of this process so far, bytes.
uint64_t peak_memory_bytes();

/// Writes stats.json() atomically; throws a user error when the file cannot be written.
void write_stats(const Stats& stats, const std::filesystem::path& file);

}  // namespace wale
