#pragma once
#include <filesystem>
#include <functional>

#include "host/film.h"
#include "host/stats.h"
#include "host/wavefront.h"

namespace wale {

struct RenderOptions {
  int spp = 64;        ///< samples per pixel
  double seconds = 0;  ///< > 0: stop after this time, whatever spp says
  uint32_t pool = 0;   ///< paths in flight; 0 = from the device
  bool aovs = false;
  bool count_cpu_time = false;  ///< stages by CPU time: see Wavefront::count_cpu_time
  RayRecord* record = nullptr;  ///< keeps the rays that are sent
  std::filesystem::path kernel_dir;
};

struct Rendered {
  Image image;
  WaveCounts counts;
  double seconds = 0;
  int samples = 0;       ///< per pixel, of the pixels that have most
  bool stopped = false;  ///< by Ctrl-C or the time limit
  uint32_t pool = 0;     ///< paths in flight
  uint64_t path_bytes = 0;
};

/// Renders a world on a device. The picture depends on the scene, spp and seed alone: not on pool, threads or device
/// count. Ctrl-C and the time limit stop between waves and keep what is there.
Rendered render(const Device& device, const World& world, const SceneDevice& scene, const IntegratorScene& integrator,
                const RenderOptions& options, const std::function<void(double fraction)>& progress = {});

}  // namespace wale
