#pragma once
#include <cstdint>
#include <vector>

#include "geom/wide_tree.h"
#include "host/device.h"
#include "host/leaf_buffers.h"
#include "host/leaf_steps.h"

namespace wale {

struct PlyTree;

/// What a tree of plies needs to follow moved positions without being built again: about one byte a segment. Nodes
/// keep their children; leaves and all boxes change, on the device alone. A tree whose positions did not move stays bit
/// for bit what it was.
class PlyRefit {
 public:
  PlyRefit() = default;
  /// `runs` as kernel pack_leaves takes them; all buffers are kept.
  PlyRefit(const Device& device, const Buffer<uint32_t>& runs, const Buffer<float>& positions, const WideTree& wide,
           const PlyTree& tree, const LeafSteps& steps);

  /// Packs and refits what `positions` holds now; returns before the device is done.
  void run(const Device& device);
  /// On the device.
  size_t bytes() const { return runs_.bytes() + steps_.bytes(); }

 private:
  size_t patches() const { return runs_.count() / 4; }

  Buffer<uint32_t> runs_;
  LeafSteps steps_;
  std::vector<uint32_t> level_offset_;
  std::vector<LeafBuffers::Part> parts_;
  cl::Kernel leaves_, nodes_;
};

}  // namespace wale
