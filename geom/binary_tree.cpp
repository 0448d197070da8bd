#include "geom/binary_tree.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <mutex>
#include <unordered_map>

#include "geom/run_tasks.h"
#include "shared/wale_types.h"

namespace wale {
namespace {

using Entry = BinaryTree::Entry;

constexpr uint32_t kBins = 64;
// So few entries are split at the best place of all, without bins.
constexpr uint32_t kFew = 8;
// Subtrees of so many entries are one task. Part of the algorithm, not of the number of threads: nothing depends on it.
constexpr uint32_t kTask = 4096;

// Twice the centre.
float centre(const Box& b, int axis) { return b.lo[axis] + b.hi[axis]; }

struct Place {
  float cost = INFINITY;
  int axis = -1;
  uint32_t at = 0;  // last bin, or number of entries, on the left
};

uint32_t split_few(Entry* entries, uint32_t count) {
  std::array<Entry, kFew> sorted[3];
  Place best;
  for (int axis = 0; axis < 3; ++axis) {
    auto& s = sorted[axis];
    for (uint32_t i = 0; i < count; ++i) {  // by insertion, which copes with any numbers
      uint32_t at = i;
      for (; at > 0 && centre(entries[i].box, axis) < centre(s[at - 1].box, axis); --at) s[at] = s[at - 1];
      s[at] = entries[i];
    }
    std::array<float, kFew> right_cost{};
    Box side;
    for (uint32_t i = count - 1; i > 0; --i) {
      join(side, s[i].box);
      right_cost[i] = half_area(side) * float(count - i);
    }
    side = Box{};
    for (uint32_t i = 1; i < count; ++i) {
      join(side, s[i - 1].box);
      const float cost = half_area(side) * float(i) + right_cost[i];
      if (cost < best.cost) best = {cost, axis, i};
    }
  }
  if (best.axis < 0) return count / 2;
  std::copy_n(sorted[best.axis].begin(), count, entries);
  return best.at;
}

// Binned surface area heuristic over the three axes (Wald 2007).
uint32_t split_many(Entry* entries, uint32_t count) {
  float lo[3] = {INFINITY, INFINITY, INFINITY}, hi[3] = {-INFINITY, -INFINITY, -INFINITY}, scale[3];
  for (uint32_t i = 0; i < count; ++i)
    for (int k = 0; k < 3; ++k) {
      const float c = centre(entries[i].box, k);
      lo[k] = c < lo[k] ? c : lo[k];
      hi[k] = c > hi[k] ? c : hi[k];
    }
  for (int k = 0; k < 3; ++k) {
    scale[k] = hi[k] > lo[k] ? float(kBins) / (hi[k] - lo[k]) : 0.0f;
    if (!std::isfinite(scale[k])) scale[k] = 0;
  }
  const auto bin_of = [&](const Box& box, int axis) {
    const float x = (centre(box, axis) - lo[axis]) * scale[axis];
    return x > 0 ? std::min(uint32_t(std::min(x, float(kBins))), kBins - 1) : 0u;
  };
  std::array<std::array<Box, kBins>, 3> box;
  std::array<std::array<uint32_t, kBins>, 3> number{};
  for (uint32_t i = 0; i < count; ++i)
    for (int axis = 0; axis < 3; ++axis) {
      const uint32_t bin = bin_of(entries[i].box, axis);
      join(box[axis][bin], entries[i].box);
      ++number[axis][bin];
    }
  Place best;
  for (int axis = 0; axis < 3; ++axis) {
    if (scale[axis] == 0) continue;
    std::array<float, kBins> right_cost{};
    Box side;
    uint32_t n = 0;
    for (uint32_t bin = kBins - 1; bin > 0; --bin) {
      join(side, box[axis][bin]);
      n += number[axis][bin];
      right_cost[bin] = half_area(side) * float(n);
    }
    side = Box{};
    n = 0;
    for (uint32_t bin = 0; bin + 1 < kBins; ++bin) {
      join(side, box[axis][bin]);
      n += number[axis][bin];
      const float cost = half_area(side) * float(n) + right_cost[bin + 1];
      if (n > 0 && n < count && cost < best.cost) best = {cost, axis, bin};
    }
  }
  if (best.axis < 0) return count / 2;
  const auto middle =
      std::partition(entries, entries + count, [&](const Entry& e) { return bin_of(e.box, best.axis) <= best.at; });
  return uint32_t(middle - entries);
}

}  // namespace

/* The cheapest way to cut a subtree into at most i children of a wide node, by dynamic programming: the cost is the
   summed area of wide nodes, as leaves cost the same however they are grouped (after Ylitie et al. 2017, section 3).
   With more slots than entries nothing gets cheaper. */
struct BinaryTree::Plan {
  Box box;
  uint32_t most = 1;                      // slots that it can use
  float cost[W_NODE_WIDTH + 1] = {0, 0};  // for 1 to `most` slots
};

BinaryTree::Plan BinaryTree::leaf_plan(uint32_t entry) const { return {entries_[entry].box, 1, {0, 0}}; }

BinaryTree::Plan BinaryTree::join_plans(const BinaryRange& r, const Plan& left, const Plan& right) {
  Plan plan;
  plan.box = left.box;
  join(plan.box, right.box);
  plan.most = std::min<uint32_t>(r.count, W_NODE_WIDTH);
  uint64_t shares = 0;
  uint64_t share = 1;
  for (uint32_t slots = 2; slots <= plan.most; ++slots) {
    plan.cost[slots] = INFINITY;
    share = slots > right.most ? slots - right.most : 1;
    for (uint32_t to_left = uint32_t(share); to_left < slots && to_left <= left.most; ++to_left) {
      const float cost = left.cost[to_left] + right.cost[slots - to_left];
      if (cost < plan.cost[slots]) {
        plan.cost[slots] = cost;
        share = to_left;
      }
    }
    shares |= share << 4 * (slots - 2);
  }
  plan.cost[1] = half_area(plan.box) + plan.cost[plan.most];
  for (uint32_t slots = 2; slots <= plan.most && slots < W_NODE_WIDTH; ++slots)
    if (plan.cost[1] < plan.cost[slots]) {
      plan.cost[slots] = plan.cost[1];
      shares &= ~(uint64_t(15) << 4 * (slots - 2));
    }
  constexpr int kAll = 4 * (W_NODE_WIDTH - 2);
  nodes_[r.node].shares = (shares & ~(uint64_t(15) << kAll)) | share << kAll;
  return plan;
}

uint32_t BinaryTree::left_slots(const BinaryRange& r, uint32_t slots) const {
  if (slots < W_NODE_WIDTH) slots = std::min(slots, r.count);
  return slots < 2 ? 0 : uint32_t(nodes_[r.node].shares >> 4 * (slots - 2) & 15);
}

uint32_t BinaryTree::split(const BinaryRange& r) {
  Entry* entries = entries_.data() + r.first;
  return r.count <= kFew ? split_few(entries, r.count) : split_many(entries, r.count);
}

BinaryTree::Plan BinaryTree::grow(const BinaryRange& r) {
  if (r.count == 1) return leaf_plan(r.first);
  nodes_[r.node].left = split(r);
  const Plan left = grow(this->left(r));
  return join_plans(r, left, grow(right(r)));
}

BinaryRange BinaryTree::build(uint32_t first, uint32_t count, unsigned threads) {
  const BinaryRange all{first, count, first};
  if (count <= kTask) {
    if (count > 0) grow(all);
    return all;
  }
  std::mutex mutex;
  std::unordered_map<uint32_t, Plan> grown;  // by first entry
  run_tasks(threads, std::vector{all}, [&](const BinaryRange& r, const auto& add) {
    if (r.count > kTask) {
      nodes_[r.node].left = split(r);
      add(right(r));
      add(left(r));
      return;
    }
    const Plan plan = grow(r);
    const std::lock_guard lock(mutex);
    grown.emplace(r.first, plan);
  });
  const auto plan_top = [&](const auto& self, const BinaryRange& r) -> Plan {
    if (r.count <= kTask) return grown.at(r.first);
    const Plan left = self(self, this->left(r));
    return join_plans(r, left, self(self, right(r)));
  };
  plan_top(plan_top, all);
  return all;
}

}  // namespace wale
