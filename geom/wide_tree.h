#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "geom/vec.h"

namespace wale {

struct Box {
  float lo[3] = {1e30f, 1e30f, 1e30f};
  float hi[3] = {-1e30f, -1e30f, -1e30f};
};

/// A tree of 16-wide nodes in the layout of kernels/shared/wale_types.h (W_NODE_WORDS words a node, root = node 0).
struct WideTree {
  std::vector<uint32_t> words;      ///< W_NODE_WORDS per node; floats by bit pattern
  std::vector<uint32_t> node_cell;  ///< per node: the cell whose root it is, or 0xffffffff
  size_t nodes() const;
};

/// Builds the tree over items (patches, or leaves of triangles). `leaf_code` is stored as child code of item i with
/// W_CHILD_LEAF set. Items of one group (UV cell; `group` non-decreasing, empty = no groups) hang below one node
/// flagged W_CHILD_CELL; `group_box` (may be empty) is joined to the bounds of the group, so that the base triangles of
/// a cell are inside too; it is indexed by cell number. Binned SAH, collapsed to width 16 at the least summed node
/// area; deterministic.
WideTree build_wide_tree(std::span<const Box> boxes, std::span<const uint32_t> leaf_code,
                         std::span<const uint32_t> group, std::span<const Box> group_box);

}  // namespace wale
