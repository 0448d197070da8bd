#pragma once
#include <cstdint>
#include <vector>

#include "host/fabric_device.h"
#include "host/ray_batch.h"
#include "host/world.h"
#include "tests/kernels/ply_oracle.h"

namespace wale::bench {

/// A ray as the brute-force oracle takes it, and what the device found.
struct CheckedRay {
  test::Ray ray;
  long skip = -1;  ///< segment that it starts on
  bool shadow = false;
  bool blocked = false;  ///< shadow
  float t = 1e30f;       ///< metres
  uint32_t kind = 0;     ///< W_HIT_*
  uint32_t segment = 0;  ///< of W_HIT_PLY
};

struct Agreement {
  size_t checked = 0, agree = 0;
  /// Silhouettes within rounding may go either way: fewer than one ray in a hundred.
  bool passes() const { return checked > 0 && double(checked - agree) <= 0.01 * double(checked); }
};

/// Plies of a world as the device numbers them, for the oracle. Fibres are plies of no optical depth.
class Oracle {
 public:
  /// `opaque`: nothing passes through plies. Keeps references to the world and its fabric.
  Oracle(const Device& device, const World& world, const FabricDevice& fabric, bool opaque);

  /// About `count` rays of a batch, evenly spread over it, and what was found for them.
  std::vector<CheckedRay> sample(const RayBatch& batch, const std::vector<w_float4>& found, size_t count) const;
  /// Traces the rays in long double against every segment near their lines. Shadow rays that props block are not
  /// checked.
  Agreement check(const std::vector<CheckedRay>& rays) const;

 private:
  uint32_t segment(uint32_t code) const;

  const FabricDevice& fabric_;
  bool props_;
  std::vector<float> positions_;  // x, y, z a vertex
  std::vector<PlyPatch> patches_;
};

}  // namespace wale::bench
