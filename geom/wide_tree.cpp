#include "geom/wide_tree.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>

#include "geom/error.h"
#include "shared/wale_types.h"

namespace wale {
namespace {

constexpr int kBins = 16;
constexpr uint32_t kLeaf = 0xffffffffu;

void join(Box& a, const Box& b) {
  for (int k = 0; k < 3; ++k) {
    a.lo[k] = std::min(a.lo[k], b.lo[k]);
    a.hi[k] = std::max(a.hi[k], b.hi[k]);
  }
}

float half_area(const Box& b) {
  const float x = b.hi[0] - b.lo[0], y = b.hi[1] - b.lo[1], z = b.hi[2] - b.lo[2];
  return x < 0 ? 0.0f : x * y + y * z + z * x;
}

float centre2(const Box& b, int axis) { return b.lo[axis] + b.hi[axis]; }

// A binary tree over a range of entries (items or whole groups), one entry a leaf. The children of node i are `left`
// and `left` + 1; a leaf has left = kLeaf and its entry.
struct Binary {
  struct Node {
    Box box;
    uint32_t left = kLeaf, entry = 0;
  };
  std::vector<Node> nodes;
};

// Where [first, last) of `order` is split: binned SAH over the three axes, halves when all centres agree.
uint32_t split(const std::vector<Box>& boxes, std::vector<uint32_t>& order, uint32_t first, uint32_t last) {
  float lo[3] = {INFINITY, INFINITY, INFINITY}, hi[3] = {-INFINITY, -INFINITY, -INFINITY};
  for (uint32_t i = first; i < last; ++i)
    for (int k = 0; k < 3; ++k) {
      lo[k] = std::min(lo[k], centre2(boxes[order[i]], k));
      hi[k] = std::max(hi[k], centre2(boxes[order[i]], k));
    }
  float best = INFINITY;
  int best_axis = -1, best_bin = 0;
  const auto bin_of = [&](uint32_t entry, int axis) {
    const float x = (centre2(boxes[entry], axis) - lo[axis]) * (float(kBins) / (hi[axis] - lo[axis]));
    return std::clamp(int(x), 0, kBins - 1);
  };
  for (int axis = 0; axis < 3; ++axis) {
    if (!(hi[axis] > lo[axis]) || !std::isfinite(float(kBins) / (hi[axis] - lo[axis]))) continue;
    std::array<Box, kBins> box;
    std::array<uint32_t, kBins> count{};
    for (uint32_t i = first; i < last; ++i) {
      const int bin = bin_of(order[i], axis);
      join(box[bin], boxes[order[i]]);
      ++count[bin];
    }
    std::array<float, kBins> right_cost{};
    Box right;
    for (uint32_t bin = kBins - 1, n = 0; bin > 0; --bin) {
      join(right, box[bin]);
      n += count[bin];
      right_cost[bin] = half_area(right) * float(n);
    }
    Box left;
    for (uint32_t bin = 0, n = 0; bin + 1 < kBins; ++bin) {
      join(left, box[bin]);
      n += count[bin];
      const float cost = half_area(left) * float(n) + right_cost[bin + 1];
      if (n > 0 && n < last - first && cost < best) {
        best = cost;
        best_axis = axis;
        best_bin = int(bin);
      }
    }
  }
  if (best_axis < 0) return (first + last) / 2;
  const auto middle = std::stable_partition(order.begin() + first, order.begin() + last,
                                            [&](uint32_t entry) { return bin_of(entry, best_axis) <= best_bin; });
  return uint32_t(middle - order.begin());
}

Binary build_binary(const std::vector<Box>& boxes) {
  Binary tree;
  std::vector<uint32_t> order(boxes.size());
  std::iota(order.begin(), order.end(), 0u);
  tree.nodes.reserve(2 * boxes.size());
  tree.nodes.emplace_back();
  struct Work {
    uint32_t node, first, last;
  };
  std::vector<Work> stack{{0, 0, uint32_t(boxes.size())}};
  while (!stack.empty()) {
    const Work work = stack.back();
    stack.pop_back();
    Box box;
    for (uint32_t i = work.first; i < work.last; ++i) join(box, boxes[order[i]]);
    tree.nodes[work.node].box = box;
    if (work.last - work.first == 1) {
      tree.nodes[work.node].entry = order[work.first];
      continue;
    }
    const uint32_t middle = split(boxes, order, work.first, work.last);
    const uint32_t left = uint32_t(tree.nodes.size());
    tree.nodes[work.node].left = left;
    tree.nodes.resize(left + 2);
    stack.push_back({left, work.first, middle});
    stack.push_back({left + 1, middle, work.last});
  }
  return tree;
}

// The cheapest way to cut a binary subtree into at most i children of a wide node, by dynamic programming: the cost is
// the summed area of wide nodes, as leaves cost the same however they are grouped (after Ylitie et al. 2017, section
// 3). share[i] is how many of i slots go to the left child; 0 = this subtree takes one slot.
struct Cut {
  std::array<float, W_NODE_WIDTH + 1> cost{};
  std::array<uint8_t, W_NODE_WIDTH + 1> share{};
};

std::vector<Cut> plan_collapse(const Binary& tree) {
  std::vector<Cut> cuts(tree.nodes.size());
  for (size_t i = tree.nodes.size(); i-- > 0;) {  // children come after their parent
    const auto& node = tree.nodes[i];
    Cut& cut = cuts[i];
    if (node.left == kLeaf) continue;
    const Cut &left = cuts[node.left], &right = cuts[node.left + 1];
    for (int slots = 2; slots <= W_NODE_WIDTH; ++slots) {
      cut.cost[slots] = INFINITY;
      for (int to_left = 1; to_left < slots; ++to_left) {
        const float cost = left.cost[to_left] + right.cost[slots - to_left];
        if (cost < cut.cost[slots]) {
          cut.cost[slots] = cost;
          cut.share[slots] = uint8_t(to_left);
        }
      }
    }
    cut.cost[1] = half_area(node.box) + cut.cost[W_NODE_WIDTH];
    for (int slots = 2; slots < W_NODE_WIDTH; ++slots)
      if (cut.cost[1] <= cut.cost[slots]) {
        cut.cost[slots] = cut.cost[1];
        cut.share[slots] = 0;
      }
  }
  return cuts;
}

class Writer {
 public:
  explicit Writer(WideTree& tree) : tree_(tree) {}

  uint32_t add_node(uint32_t cell) {
    const uint32_t node = uint32_t(tree_.node_cell.size());
    if (node > W_CHILD_INDEX) user_error("tree: {} nodes are too many; use fewer repeats of the pattern", node);
    tree_.node_cell.push_back(cell);
    tree_.words.resize(tree_.words.size() + W_NODE_WORDS, std::bit_cast<uint32_t>(1e30f));
    uint32_t* words = tree_.words.data() + size_t(node) * W_NODE_WORDS;
    std::fill(words + 48, words + 96, std::bit_cast<uint32_t>(-1e30f));
    std::fill(words + 96, words + W_NODE_WORDS, W_NONE);
    return node;
  }

  // Slab tests round; four units in the last place of each plane keep them conservative (traverse.clh).
  void set_child(uint32_t node, int slot, const Box& box, uint32_t code) {
    uint32_t* words = tree_.words.data() + size_t(node) * W_NODE_WORDS + slot;
    for (int k = 0; k < 3; ++k) {
      const float lo = box.lo[k] - (std::abs(box.lo[k]) * 4.8e-7f + 1e-30f);
      const float hi = box.hi[k] + (std::abs(box.hi[k]) * 4.8e-7f + 1e-30f);
      words[16 * k] = std::bit_cast<uint32_t>(lo);
      words[48 + 16 * k] = std::bit_cast<uint32_t>(hi);
    }
    words[96] = code;
  }

  // Writes the subtree of `root` as wide node `node`; `child_code(entry)` is called for entries in order.
  template <typename ChildCode>
  void write(const Binary& tree, const std::vector<Cut>& cuts, uint32_t node, uint32_t cell,
             const ChildCode& child_code) {
    struct Work {
      uint32_t binary, wide;
    };
    std::vector<Work> stack{{0, node}};
    std::vector<std::pair<uint32_t, int>> open;
    while (!stack.empty()) {
      const Work work = stack.back();
      stack.pop_back();
      int slot = 0;
      open.assign(1, {work.binary, W_NODE_WIDTH});
      bool first = true;  // the node itself is opened, whatever its share of one slot says
      while (!open.empty()) {
        const auto [binary, slots] = open.back();
        open.pop_back();
        const auto& b = tree.nodes[binary];
        const int to_left = b.left == kLeaf ? 0 : cuts[binary].share[slots];
        if (to_left == 0 && !(first && b.left != kLeaf)) {
          uint32_t code;
          if (b.left == kLeaf) {
            code = child_code(b.entry);
          } else {
            code = add_node(cell);
            stack.push_back({binary, code});
          }
          set_child(work.wide, slot++, b.box, code);
        } else {
          open.push_back({b.left + 1, slots - to_left});
          open.push_back({b.left, to_left});
        }
        first = false;
      }
    }
  }

 private:
  WideTree& tree_;
};

}  // namespace

size_t WideTree::nodes() const { return node_cell.size(); }

WideTree build_wide_tree(std::span<const Box> boxes, std::span<const uint32_t> leaf_code,
                         std::span<const uint32_t> group, std::span<const Box> group_box) {
  if (boxes.size() != leaf_code.size() || (!group.empty() && group.size() != boxes.size()))
    bug("tree: {} boxes, {} leaves, {} groups", boxes.size(), leaf_code.size(), group.size());
  WideTree tree;
  Writer writer(tree);
  const uint32_t root = writer.add_node(W_NONE);
  if (boxes.empty()) return tree;
  const auto write_items = [&](size_t first, size_t last, uint32_t node, uint32_t cell) {
    const auto code = [&](uint32_t entry) { return leaf_code[first + entry] | W_CHILD_LEAF; };
    if (last - first <= W_NODE_WIDTH) {
      for (size_t i = first; i < last; ++i) writer.set_child(node, int(i - first), boxes[i], code(uint32_t(i - first)));
      return;
    }
    const Binary binary = build_binary({boxes.begin() + first, boxes.begin() + last});
    writer.write(binary, plan_collapse(binary), node, cell, code);
  };
  if (group.empty()) {
    write_items(0, boxes.size(), root, W_NONE);
    return tree;
  }

  std::vector<size_t> first_of;  // runs of equal group
  std::vector<Box> run_box;
  for (size_t i = 0; i < boxes.size(); ++i) {
    if (i == 0 || group[i] != group[i - 1]) {
      if (i > 0 && group[i] < group[i - 1]) bug("tree: group {} follows group {}", group[i], group[i - 1]);
      first_of.push_back(i);
      run_box.push_back(group[i] < group_box.size() ? group_box[group[i]] : Box{});
    }
    join(run_box.back(), boxes[i]);
  }
  first_of.push_back(boxes.size());
  const auto write_group = [&](uint32_t run) {
    const uint32_t cell = group[first_of[run]];
    const uint32_t node = writer.add_node(cell);
    write_items(first_of[run], first_of[run + 1], node, cell);
    return node | W_CHILD_CELL;
  };
  if (run_box.size() <= W_NODE_WIDTH) {
    for (uint32_t run = 0; run < run_box.size(); ++run) {
      const uint32_t code = write_group(run);
      writer.set_child(root, int(run), run_box[run], code);
    }
    return tree;
  }
  const Binary binary = build_binary(run_box);
  writer.write(binary, plan_collapse(binary), root, W_NONE, write_group);
  return tree;
}

}  // namespace wale
