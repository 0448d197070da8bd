#include "host/work_list.h"

#include <algorithm>

namespace wale {

WorkList::WorkList(uint32_t blocks, uint32_t samples, uint32_t devices)
    : blocks_(blocks), samples_(samples), devices_(devices) {}

// First block with the fewest samples that nobody is tracing; its own device's before those of nobody and of others.
std::optional<uint32_t> WorkList::farthest_behind(uint32_t device) const {
  std::optional<uint32_t> best;
  const auto rank = [&](const Block& b) {
    return std::pair(b.done, b.owner == device ? 0 : b.owner == kNobody ? 1 : 2);
  };
  for (uint32_t i = 0; i < blocks_.size(); ++i) {
    const Block& b = blocks_[i];
    if (b.busy || b.done == samples_) continue;
    if (!best || rank(b) < rank(blocks_[*best])) best = i;
  }
  return best;
}

std::optional<WorkUnit> WorkList::take(uint32_t device, uint32_t paths, uint32_t block_pixels, uint32_t even) {
  std::unique_lock lock(mutex_);
  std::optional<uint32_t> first;
  while (!stopped_ && done_ < uint64_t(samples_) * blocks_.size()) {
    first = farthest_behind(device);
    if (first) break;
    changed_.wait(lock);
  }
  if (!first) return {};

  WorkUnit unit;
  unit.first_block = *first;
  unit.first_sample = blocks_[*first].done;
  const uint32_t left = samples_ - unit.first_sample, block_paths = std::max(1u, paths / block_pixels);
  unit.samples = std::min({left, even, block_paths});
  // No device takes more than its share at once: the others would have to wait for it.
  const uint32_t share = uint32_t((blocks_.size() + devices_ - 1) / devices_);
  const uint32_t most = std::min(share, std::max(1u, block_paths / unit.samples));
  const uint32_t owner = blocks_[*first].owner;
  for (uint32_t i = *first; i < blocks_.size() && unit.blocks < most; ++i) {
    Block& b = blocks_[i];
    if (b.busy || b.done != unit.first_sample || b.owner != owner) break;
    b.busy = true;
    if (b.owner != device && b.owner != kNobody) unit.elsewhere.emplace_back(i, b.owner);
    b.owner = device;
    ++unit.blocks;
  }
  // What is left of the wave goes to more samples; with several devices in steps that still let them share the rest.
  const uint32_t fit = block_paths / unit.blocks / even * even;
  const uint32_t fair = devices_ > 1 ? left / 4 / even * even : left;
  unit.samples = std::max(unit.samples, std::min({left, fit, fair}));
  return unit;
}

void WorkList::finish(const WorkUnit& unit) {
  {
    const std::lock_guard lock(mutex_);
    for (uint32_t i = unit.first_block; i < unit.first_block + unit.blocks; ++i) {
      blocks_[i].done += unit.samples;
      blocks_[i].busy = false;
    }
    done_ += uint64_t(unit.blocks) * unit.samples;
  }
  changed_.notify_all();
}

void WorkList::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
  }
  changed_.notify_all();
}

double WorkList::fraction() const {
  const std::lock_guard lock(mutex_);
  return double(done_) / (double(samples_) * double(blocks_.size()));
}

uint32_t WorkList::most_samples() const {
  const std::lock_guard lock(mutex_);
  uint32_t most = 0;
  for (const Block& b : blocks_) most = std::max(most, b.done);
  return most;
}

std::optional<uint32_t> WorkList::owner(uint32_t block) const {
  const std::lock_guard lock(mutex_);
  if (blocks_[block].owner == kNobody) return {};
  return blocks_[block].owner;
}

}  // namespace wale
