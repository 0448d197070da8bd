#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "shared/wale_types.h"

namespace wale {

enum class RayKind { primary, bounce, shadow };

/// The rays of one launch of the traversal, as a render sent them, and all that it takes to send them again.
struct RayBatch {
  RayKind kind = RayKind::primary;
  WFrame frame{};  ///< of the wave; with slot and depth it decides each ray's key
  uint32_t depth = 0;
  std::vector<uint32_t> tiles;    ///< of the wave
  std::vector<uint32_t> slots;    ///< of the wave's paths, in the order of the launch
  std::vector<w_float4> o, l, d;  ///< per ray; words as in kernels/stages/path_state.clh
  std::vector<w_float4> found;    ///< primary and bounce: t, kind, code (bits) as the render found them
};

/// What a render keeps of its rays while it runs: every ray of each `every`-th wave.
struct RayRecord {
  uint32_t every = 1;
  std::vector<RayBatch> batches;

  uint64_t rays(RayKind kind) const {
    uint64_t sum = 0;
    for (const RayBatch& b : batches)
      if (b.kind == kind) sum += b.slots.size();
    return sum;
  }
};

}  // namespace wale
