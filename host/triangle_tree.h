#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "geom/wide_tree.h"

namespace wale {

/// Triangles in leaves of up to 16 lanes (W_TRI_LEAF_WORDS words each) and the tree over them. `order[i]` is the input
/// triangle that became triangle i: leaves hold runs of consecutive numbers.
struct TriangleTree {
  std::vector<uint32_t> order;
  std::vector<float> leaves;
  WideTree tree;
};

/// Corners: 9 floats per triangle. Splits at the object median of the widest axis until a leaf is full at most.
TriangleTree build_triangle_tree(std::span<const float> corners);

}  // namespace wale
