#pragma once
#include <cstdint>

#include "geom/wide_tree.h"
#include "host/device.h"

namespace wale {

/// A wide tree in the form that one ray per work-item goes down by (W_QUANTISED_* and W_LEAF_BOX_* in
/// kernels/shared/wale_types.h; kernels/geometry/traverse_simt.clh): nodes of 128 bytes that keep their numbers, and the
/// exact boxes of leaves apart.
class QuantisedTree {
 public:
  QuantisedTree() = default;
  /// `wide`: a tree without cells, or an empty one; `nodes`: its words on the device.
  QuantisedTree(const Device& device, const WideTree& wide, const Buffer<uint32_t>& nodes);

  /// Follows `nodes` after their boxes have changed; children must be the same. Returns before the device is done.
  void requantise(const Device& device, const Buffer<uint32_t>& nodes);

  const Buffer<uint32_t>& nodes() const { return nodes_; }
  const Buffer<uint32_t>& leaf_boxes() const { return leaf_boxes_; }
  /// On the device; 0 where there is no such tree.
  size_t bytes() const { return first_leaf_.count() ? nodes_.bytes() + leaf_boxes_.bytes() + first_leaf_.bytes() : 0; }

 private:
  Buffer<uint32_t> nodes_, leaf_boxes_, first_leaf_;
};

}  // namespace wale
