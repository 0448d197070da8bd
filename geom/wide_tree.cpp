#include "geom/wide_tree.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <thread>

#include "geom/binary_tree.h"
#include "geom/error.h"
#include "shared/wale_types.h"

namespace wale {
namespace {

// What a wide node is made of: a part of the tree over items, or of the tree over groups.
struct Part {
  BinaryRange range;
  uint32_t cell = W_NONE;
  bool of_groups = false;
};

// Slab tests round; four units in the last place of each plane keep them conservative (traverse.clh). Growing with the
// plane, so that it changes nothing whether boxes are widened before or after they are joined.
Box widened(const Box& box) {
  Box out;
  for (int k = 0; k < 3; ++k) {
    out.lo[k] = box.lo[k] - (std::abs(box.lo[k]) * 4.8e-7f + 1e-30f);
    out.hi[k] = box.hi[k] + (std::abs(box.hi[k]) * 4.8e-7f + 1e-30f);
  }
  return out;
}

class Builder {
 public:
  Builder(std::span<const Box> boxes, std::span<const uint32_t> leaf_code, std::span<const uint32_t> group,
          std::span<const Box> group_box, unsigned threads)
      : leaf_code_(leaf_code), group_box_(group_box), threads_(threads), items_(entries_of(boxes)), groups_({}) {
    if (!group.empty()) {
      find_runs(boxes, group);
    } else if (!boxes.empty()) {
      nodes_.push_back({items_.build(0, uint32_t(boxes.size()), threads), W_NONE, false});
    }
    if (nodes_.empty()) nodes_.push_back({});
  }

  WideTree build() {
    parent_.push_back(W_NONE);
    tree_.level_offset = {0};
    lay_out();
    tree_.words.resize(nodes_.size() * W_NODE_WORDS);
    tree_.node_cell.reserve(nodes_.size());
    for (const Part& part : nodes_) tree_.node_cell.push_back(part.cell);
    for (uint32_t node = 0; node < nodes_.size(); ++node) clear(node);
    write();
    return std::move(tree_);
  }

 private:
  static std::vector<BinaryTree::Entry> entries_of(std::span<const Box> boxes) {
    std::vector<BinaryTree::Entry> entries(boxes.size());
    for (uint32_t i = 0; i < boxes.size(); ++i) entries[i] = {boxes[i], i};
    return entries;
  }

  // Runs of equal group: a tree over the items of each, and one over all runs.
  void find_runs(std::span<const Box> boxes, std::span<const uint32_t> group) {
    std::vector<BinaryTree::Entry> runs;
    for (size_t i = 0; i < boxes.size(); ++i) {
      if (i == 0 || group[i] != group[i - 1]) {
        if (i > 0 && group[i] < group[i - 1]) bug("tree: group {} follows group {}", group[i], group[i - 1]);
        runs.push_back({group_bounds(group[i]), uint32_t(runs.size())});
        run_.push_back({{uint32_t(i), 0, uint32_t(i)}, group[i], false});
      }
      join(runs.back().box, boxes[i]);
      ++run_.back().range.count;
    }
    for (Part& run : run_) run.range = items_.build(run.range.first, run.range.count, threads_);
    const uint32_t count = uint32_t(runs.size());
    groups_ = BinaryTree(std::move(runs));
    if (count > 0) nodes_.push_back({groups_.build(0, count, threads_), W_NONE, true});
  }

  Box group_bounds(uint32_t cell) const { return cell < group_box_.size() ? group_box_[cell] : Box{}; }

  // Calls child(slot, part, entry) for the children of a node in order; entry: the child is a single one.
  template <typename Child>
  void for_children(const Part& part, const Child& child) const {
    const BinaryTree& tree = part.of_groups ? groups_ : items_;
    if (part.range.count == 0) return;
    std::vector<std::pair<BinaryRange, uint32_t>>& open = open_;
    open.assign(1, {part.range, W_NODE_WIDTH});
    for (uint32_t slot = 0; !open.empty();) {
      const auto [range, slots] = open.back();
      open.pop_back();
      const uint32_t to_left = range.count == 1 ? 0 : tree.left_slots(range, slots);
      if (to_left == 0) {
        child(slot++, Part{range, part.cell, part.of_groups}, range.count == 1);
      } else {
        open.push_back({tree.right(range), slots - to_left});
        open.push_back({tree.left(range), to_left});
      }
    }
  }

  // Numbers the nodes: level by level, the children of one next to each other.
  void lay_out() {
    for (uint32_t level = 0; level < nodes_.size(); level = tree_.level_offset.back()) {
      const uint32_t end = uint32_t(nodes_.size());
      for (uint32_t node = level; node < end; ++node) {
        const Part part = nodes_[node];
        for_children(part, [&](uint32_t slot, const Part& child, bool entry) {
          if (entry && !part.of_groups) return;
          nodes_.push_back(entry ? run_[groups_.entry(child.range.first).number] : child);
          parent_.push_back(node * W_NODE_WIDTH + slot);
        });
      }
      if (nodes_.size() > UINT32_MAX / W_NODE_WIDTH)
        user_error("tree: {} nodes are too many; use fewer repeats of the pattern", nodes_.size());
      tree_.level_offset.push_back(end);
    }
  }

  void clear(uint32_t node) {
    uint32_t* words = tree_.words.data() + size_t(node) * W_NODE_WORDS;
    std::fill(words, words + 48, std::bit_cast<uint32_t>(1e30f));
    std::fill(words + 48, words + 96, std::bit_cast<uint32_t>(-1e30f));
    std::fill(words + W_NODE_CHILD, words + W_NODE_WORDS, W_NONE);
    words[W_NODE_PLACE] = parent_[node];
  }

  void set_child(uint32_t place, const Box& box, uint32_t code) {
    uint32_t* words = tree_.words.data() + size_t(place / W_NODE_WIDTH) * W_NODE_WORDS + place % W_NODE_WIDTH;
    for (int k = 0; k < 3; ++k) {
      words[16 * k] = std::bit_cast<uint32_t>(box.lo[k]);
      words[48 + 16 * k] = std::bit_cast<uint32_t>(box.hi[k]);
    }
    words[W_NODE_CHILD] = code;
  }

  // From the last node to the first: children before their parents.
  void write() {
    for (uint32_t node = uint32_t(nodes_.size()); node-- > 0;) {
      const Part& part = nodes_[node];
      if (!part.of_groups)
        for_children(part, [&](uint32_t slot, const Part& child, bool entry) {
          if (!entry) return;
          const BinaryTree::Entry& item = items_.entry(child.range.first);
          set_child(node * W_NODE_WIDTH + slot, widened(item.box), leaf_code_[item.number] | W_CHILD_LEAF);
        });
      if (node == 0) return;
      const uint32_t place = parent_[node];
      const bool cell = nodes_[place / W_NODE_WIDTH].of_groups && !part.of_groups;
      Box box = cell ? widened(group_bounds(part.cell)) : Box{};
      const uint32_t* words = tree_.words.data() + size_t(node) * W_NODE_WORDS;
      for (int slot = 0; slot < W_NODE_WIDTH; ++slot)
        for (int k = 0; k < 3; ++k) {
          box.lo[k] = std::min(box.lo[k], std::bit_cast<float>(words[16 * k + slot]));
          box.hi[k] = std::max(box.hi[k], std::bit_cast<float>(words[48 + 16 * k + slot]));
        }
      set_child(place, box, cell ? node | W_CHILD_CELL : node);
    }
  }

  std::span<const uint32_t> leaf_code_;
  std::span<const Box> group_box_;
  unsigned threads_;
  BinaryTree items_, groups_;
  std::vector<Part> run_;    // per run of one group
  std::vector<Part> nodes_;  // per wide node
  std::vector<uint32_t> parent_;
  WideTree tree_;
  mutable std::vector<std::pair<BinaryRange, uint32_t>> open_;
};

}  // namespace

size_t WideTree::nodes() const { return words.size() / W_NODE_WORDS; }

WideTree build_wide_tree(std::span<const Box> boxes, std::span<const uint32_t> leaf_code,
                         std::span<const uint32_t> group, std::span<const Box> group_box, unsigned threads) {
  if (boxes.size() != leaf_code.size() || (!group.empty() && group.size() != boxes.size()))
    bug("tree: {} boxes, {} leaves, {} groups", boxes.size(), leaf_code.size(), group.size());
  if (threads == 0) threads = std::max(1u, std::thread::hardware_concurrency());
  return Builder(boxes, leaf_code, group, group_box, threads).build();
}

}  // namespace wale
