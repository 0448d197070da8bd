#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "geom/box.h"

namespace wale {

/// A tree of 16-wide nodes in the layout of kernels/shared/wale_types.h (W_NODE_WORDS words a node, root = node 0),
/// level by level, the children of a node one after the other.
struct WideTree {
  std::vector<uint32_t> words;         ///< W_NODE_WORDS per node; floats by bit pattern
  std::vector<uint32_t> node_cell;     ///< per node: the cell whose root it is, or 0xffffffff
  std::vector<uint32_t> level_offset;  ///< first node of each level, then the number of nodes
  size_t nodes() const;
};

/// Builds the tree over items (patches, or leaves of triangles). `leaf_code` is stored as child code of item i with
/// W_CHILD_LEAF set. Items of one group (UV cell; `group` non-decreasing, empty = no groups) hang below one node
/// flagged W_CHILD_CELL; `group_box` (may be empty) is joined to the bounds of the group, so that the base triangles of
/// a cell are inside too; it is indexed by cell number. Surface area heuristic, collapsed to width 16 at the least
/// summed node area (geom/binary_tree.h). The same for any number of threads; 0 = as many as the machine runs.
WideTree build_wide_tree(std::span<const Box> boxes, std::span<const uint32_t> leaf_code,
                         std::span<const uint32_t> group, std::span<const Box> group_box, unsigned threads = 0);

}  // namespace wale
