// The 16-wide tree: every item once, inside its boxes, below its group.
#include "geom/wide_tree.h"

#include <gtest/gtest.h>

#include <bit>
#include <random>
#include <stdexcept>

#include "geom/run_tasks.h"
#include "shared/wale_types.h"

namespace wale {
namespace {

struct Items {
  std::vector<Box> boxes;
  std::vector<uint32_t> codes, groups;
};

Items random_items(size_t count, size_t per_group, bool same_place, uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(-1, 1);
  Items items;
  for (size_t i = 0; i < count; ++i) {
    Box b;
    for (int k = 0; k < 3; ++k) {
      const float c = same_place ? 0.25f : 10 * uniform(random);
      b.lo[k] = c - 0.1f;
      b.hi[k] = c + 0.1f;
    }
    items.boxes.push_back(b);
    items.codes.push_back(uint32_t(3 * i));
    items.groups.push_back(uint32_t(2 * (i / per_group)));
  }
  return items;
}

struct Walk {
  const WideTree& tree;
  std::vector<int> seen;
  std::vector<int> nodes_seen;
  const Items& items;
  bool grouped;

  void node(uint32_t index, uint32_t cell) {
    ++nodes_seen[index];
    EXPECT_EQ(tree.node_cell[index], cell);
    const uint32_t* words = tree.words.data() + size_t(index) * W_NODE_WORDS;
    for (int i = 0; i < W_NODE_WIDTH; ++i) {
      const uint32_t code = words[W_NODE_CHILD + i];
      const auto lo = [&](int k) { return std::bit_cast<float>(words[16 * k + i]); };
      const auto hi = [&](int k) { return std::bit_cast<float>(words[48 + 16 * k + i]); };
      if (code == W_NONE) {
        EXPECT_GT(lo(0), hi(0));
        continue;
      }
      if (code & W_CHILD_LEAF) {
        const size_t item = (code & ~W_CHILD_LEAF) / 3;
        ++seen[item];
        if (grouped) {
          EXPECT_EQ(items.groups[item], cell);
        }
        for (int k = 0; k < 3; ++k) {
          EXPECT_LT(lo(k), items.boxes[item].lo[k]);
          EXPECT_GT(hi(k), items.boxes[item].hi[k]);
        }
        continue;
      }
      const uint32_t child = code & W_CHILD_INDEX;
      const uint32_t child_cell = tree.node_cell[child];
      EXPECT_EQ((code & W_CHILD_CELL) != 0, cell == W_NONE && child_cell != W_NONE);
      // The child's boxes lie inside the one that its parent holds for it.
      const uint32_t* inner = tree.words.data() + size_t(child) * W_NODE_WORDS;
      for (int j = 0; j < W_NODE_WIDTH; ++j)
        for (int k = 0; inner[96 + j] != W_NONE && k < 3; ++k) {
          EXPECT_LE(lo(k), std::bit_cast<float>(inner[16 * k + j]));
          EXPECT_GE(hi(k), std::bit_cast<float>(inner[48 + 16 * k + j]));
        }
      node(child, child_cell);
    }
  }
};

void check(const Items& items, bool grouped) {
  const WideTree tree = build_wide_tree(
      items.boxes, items.codes, grouped ? std::span<const uint32_t>(items.groups) : std::span<const uint32_t>{}, {});
  EXPECT_EQ(tree.words.size(), tree.nodes() * W_NODE_WORDS);
  Walk walk{tree, std::vector<int>(items.boxes.size()), std::vector<int>(tree.nodes()), items, grouped};
  walk.node(0, W_NONE);
  for (int n : walk.seen) EXPECT_EQ(n, 1);
  for (int n : walk.nodes_seen) EXPECT_EQ(n, 1);
}

TEST(WideTree, HoldsEveryItemOnceInsideItsBoxes) {
  for (size_t count : {0, 1, 15, 16, 17, 40, 1000, 5000}) check(random_items(count, 1, false, uint32_t(count)), false);
}

TEST(WideTree, GroupsHangBelowOneFlaggedNode) {
  for (size_t per_group : {1, 12, 16, 17, 90})
    for (size_t count : {1, 14, 300, 3000}) check(random_items(count, per_group, false, uint32_t(count)), true);
}

TEST(WideTree, ItemsInOnePlaceAreSplitAllTheSame) { check(random_items(2000, 40, true, 1), true); }

TEST(WideTree, SameInputSameBytes) {
  const Items items = random_items(3000, 12, false, 9);
  EXPECT_EQ(build_wide_tree(items.boxes, items.codes, items.groups, {}).words,
            build_wide_tree(items.boxes, items.codes, items.groups, {}).words);
}

// Parts large enough to be handed to threads, with and without groups.
TEST(WideTree, TheNumberOfThreadsChangesNothing) {
  for (size_t per_group : {1, 9000}) {
    const Items items = random_items(40000, per_group, false, 3);
    for (const bool grouped : {false, true}) {
      const std::span<const uint32_t> groups =
          grouped ? std::span<const uint32_t>(items.groups) : std::span<const uint32_t>{};
      const WideTree one = build_wide_tree(items.boxes, items.codes, groups, {}, 1);
      for (unsigned threads : {2, 3, 8}) {
        const WideTree several = build_wide_tree(items.boxes, items.codes, groups, {}, threads);
        EXPECT_EQ(one.words, several.words);
        EXPECT_EQ(one.node_cell, several.node_cell);
      }
    }
  }
}

TEST(WideTree, NodesStandLevelByLevelAndNameTheirParents) {
  for (const bool grouped : {false, true}) {
    const Items items = random_items(5000, 20, false, 4);
    const WideTree tree = build_wide_tree(
        items.boxes, items.codes, grouped ? std::span<const uint32_t>(items.groups) : std::span<const uint32_t>{}, {});
    ASSERT_EQ(tree.level_offset.back(), tree.nodes());
    EXPECT_EQ(tree.words[W_NODE_PLACE], W_NONE);
    ASSERT_GT(tree.level_offset.size(), 3u);
    for (size_t level = 1; level + 1 < tree.level_offset.size(); ++level)
      for (uint32_t node = tree.level_offset[level]; node < tree.level_offset[level + 1]; ++node) {
        const uint32_t place = tree.words[size_t(node) * W_NODE_WORDS + W_NODE_PLACE];
        const uint32_t parent = place / W_NODE_WIDTH, slot = place % W_NODE_WIDTH;
        EXPECT_GE(parent, tree.level_offset[level - 1]);
        EXPECT_LT(parent, tree.level_offset[level]);
        EXPECT_EQ(tree.words[size_t(parent) * W_NODE_WORDS + W_NODE_CHILD + slot] & W_CHILD_INDEX, node);
      }
  }
}

TEST(WideTree, WhatATaskThrowsReachesTheCaller) {
  const auto work = [](int task, const auto& add) {
    if (task > 40) throw std::runtime_error("task");
    add(task + 1);
    add(task + 2);
  };
  for (unsigned threads : {1, 3}) EXPECT_THROW(run_tasks(threads, std::vector{0}, work), std::runtime_error);
}

TEST(WideTree, GroupBoxesWidenTheirGroup) {
  const Items items = random_items(2, 2, true, 1);
  Box wide;
  for (int k = 0; k < 3; ++k) {
    wide.lo[k] = -50;
    wide.hi[k] = 60;
  }
  const std::vector<Box> group_box{wide};
  const WideTree tree = build_wide_tree(items.boxes, items.codes, items.groups, group_box);
  EXPECT_LE(std::bit_cast<float>(tree.words[0]), -50.0f);
  EXPECT_GE(std::bit_cast<float>(tree.words[48]), 60.0f);
}

}  // namespace
}  // namespace wale
