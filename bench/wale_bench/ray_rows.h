#pragma once
#include <string>
#include <vector>

#include "bench/wale_bench/clock.h"
#include "bench/wale_bench/verify.h"
#include "host/features.h"
#include "host/render.h"
#include "host/stage_profile.h"

namespace wale::bench {

/// Rays of one kind against one cloth, traced alone: medians over the repeats.
struct RayRow {
  RayKind kind = RayKind::primary;
  bool attenuated = false;  ///< plies let light through
  uint64_t rays = 0;
  std::vector<double> device;        ///< seconds of every repeat by the device's clock
  std::vector<double> cpu;           ///< seconds of every repeat, of all threads
  double nodes = 0, leaves = 0;      ///< visited per ray
  double bytes = 0, operations = 0;  ///< of the traversal per ray: nodes and leaves visited times their bytes
  bool repeats = true;               ///< every repeat found the same, bit for bit, and what the render had found
  Agreement agreement;               ///< with the brute-force oracle

  bool verified() const { return repeats && agreement.passes(); }
  std::string name() const;
};

/// Sends the rays of a record through the launches of a renderer again.
class RayReplay {
 public:
  /// `opaque`: the scene's plies let nothing through, other than those that the rays were recorded with.
  RayReplay(const Device& device, const World& world, const SceneDevice& scene, const Features& features,
            const RayRecord& record, uint32_t pool, bool opaque, const std::filesystem::path& kernel_dir);

  /// One repeat of all kinds; the first one warms up and is not counted.
  void repeat();
  /// Counts visits and checks `samples` rays of each kind; then the rows are done.
  std::vector<RayRow> finish(size_t samples);

 private:
  RayRow& row(RayKind kind);
  void count_visits();

  const Device& device_;
  const World& world_;
  const SceneDevice& scene_;
  Features features_;
  const RayRecord& record_;
  uint32_t pool_;
  bool opaque_, warm_ = false;
  std::filesystem::path kernel_dir_;
  Wavefront wavefront_;
  std::vector<std::vector<w_float4>> found_;  ///< per batch, of the first repeat
  std::vector<RayRow> rows_;
};

}  // namespace wale::bench
