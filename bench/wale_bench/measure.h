#pragma once
#include <string>
#include <vector>

#include "bench/wale_bench/ray_rows.h"
#include "bench/wale_bench/workload.h"
#include "host/device_rates.h"

namespace wale::bench {

struct MeasureOptions {
  int repeats = 5;
  size_t checked_rays = 128;  ///< of each row, against the oracle
  std::filesystem::path kernel_dir;
  Features also;  ///< as in RenderOptions
};

/// What one cloth gave on one device. Vectors hold one value for each repeat.
struct FabricResult {
  std::string name;
  size_t segments = 0, patches = 0, nodes = 0;
  double knit_seconds = 0;
  std::vector<double> warp, pack, tree;     ///< seconds by the wall
  std::vector<double> build_cpu;            ///< all three and the upload, of all threads
  double trace_bytes = 0, shade_bytes = 0;  ///< per segment: leaves and nodes, and with them what shading reads
  std::vector<RayRow> rays;                 ///< opaque, then attenuated

  uint64_t samples = 0;                         ///< paths of one render
  std::vector<double> render_wall, render_cpu;  ///< seconds
  /// By kind: Mrays/s of the replay over those of the render right before it; both by the device's clock, or on a CPU
  /// device by CPU time.
  std::map<std::string, std::vector<double>> replay_over_render;
  double ns_per_vertex = 0;
  std::vector<StageProfile> stages;
};

/// Knits, builds, renders and replays: each repeat is one render and, right after it, its rays alone against the same
/// plies and against opaque ones.
FabricResult measure(const Device& device, const Workload& workload, const Loaders& loaders, const DeviceRates& rates,
                     const MeasureOptions& options, const std::function<void(double)>& progress);

}  // namespace wale::bench
