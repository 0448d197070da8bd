#pragma once
#include <cstdint>
#include <vector>

#include "geom/box.h"

namespace wale {

/// Some of the entries of a BinaryTree and the inner node above them: its children are left() and right().
struct BinaryRange {
  uint32_t first = 0, count = 0;  ///< entries; one entry is a leaf
  uint32_t node = 0;              ///< number of the inner node; of no meaning for a leaf
};

/// A binary tree over boxes by the surface area heuristic, with the cheapest way to cut it into nodes of width
/// W_NODE_WIDTH. Inner nodes stand in preorder, so that a subtree over n entries holds n - 1 consecutive ones: any
/// subtree can be built on its own, by any thread, and none needs a pointer. 16 bytes an inner node, 28 an entry.
class BinaryTree {
 public:
  struct Entry {
    Box box;
    uint32_t number;
  };

  /// Entry i is boxes[i] with number i. Builds nothing yet.
  explicit BinaryTree(std::vector<Entry> entries) : entries_(std::move(entries)), nodes_(entries_.size()) {}

  /// Builds the subtree over entries [first, first + count), which it puts in the order of the leaves; the same for any
  /// number of threads. Subtrees over ranges that do not overlap may be built one after the other.
  BinaryRange build(uint32_t first, uint32_t count, unsigned threads);

  const Entry& entry(uint32_t i) const { return entries_[i]; }
  BinaryRange left(const BinaryRange& r) const { return {r.first, nodes_[r.node].left, r.node + 1}; }
  BinaryRange right(const BinaryRange& r) const {
    const uint32_t left = nodes_[r.node].left;
    return {r.first + left, r.count - left, r.node + left};
  }
  /// How many of `slots` children of a wide node go to the left subtree; 0: the subtree is one child, a wide node of
  /// its own. All W_NODE_WIDTH slots ask for the children of that wide node and give at least 1.
  uint32_t left_slots(const BinaryRange& r, uint32_t slots) const;

 private:
  struct Node {
    uint32_t left = 0;    // entries of the left subtree
    uint64_t shares = 0;  // four bits for each number of slots from 2 on
  };
  struct Plan;
  uint32_t split(const BinaryRange& r);
  Plan leaf_plan(uint32_t entry) const;
  Plan join_plans(const BinaryRange& r, const Plan& left, const Plan& right);
  Plan grow(const BinaryRange& r);

  std::vector<Entry> entries_;
  std::vector<Node> nodes_;
};

}  // namespace wale
