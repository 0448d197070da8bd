#include "host/work_list.h"

#include <algorithm>
#include <numeric>

namespace wale {

WorkList::WorkList(uint32_t blocks, uint32_t samples, uint32_t devices, bool in_a_hurry)
    : blocks_(blocks), devices_(devices), in_a_hurry_(in_a_hurry) {
  std::vector<uint32_t> all(blocks);
  std::iota(all.begin(), all.end(), 0u);
  ask(std::move(all), samples);
}

void WorkList::ask(std::vector<uint32_t> blocks, uint32_t samples) {
  const std::lock_guard lock(mutex_);
  samples_ = samples;
  open_ = std::move(blocks);
  std::erase_if(open_, [&](uint32_t b) { return blocks_[b].done >= samples; });
  for (const uint32_t b : open_) asked_ += samples - blocks_[b].done;
}

// Place in the open blocks of the first one with the fewest samples that nobody is tracing; the device's own before
// those of nobody and of others.
std::optional<size_t> WorkList::farthest_behind(uint32_t device) const {
  std::optional<size_t> best;
  std::pair<uint32_t, int> least;
  for (size_t i = 0; i < open_.size(); ++i) {
    const Block& b = blocks_[open_[i]];
    if (b.busy) continue;
    const std::pair rank(b.done, b.owner == device ? 0 : b.owner == kNobody ? 1 : 2);
    if (best && rank >= least) continue;
    best = i;
    least = rank;
  }
  return best;
}

std::optional<WorkUnit> WorkList::take(uint32_t device, uint32_t paths, uint32_t block_pixels, uint32_t even) {
  std::unique_lock lock(mutex_);
  std::optional<size_t> first;
  while (!stopped_ && !open_.empty()) {
    first = farthest_behind(device);
    if (first) break;
    changed_.wait(lock);
  }
  if (!first) return {};

  const Block like = blocks_[open_[*first]];
  WorkUnit unit;
  unit.first_sample = like.done;
  const uint32_t left = samples_ - like.done, block_paths = std::max(1u, paths / block_pixels);
  const uint32_t step = in_a_hurry_ && like.done == 0 ? 1 : even - like.done % even;
  unit.samples = std::min({left, step, block_paths});
  // No device takes more than its share at once: the others would have to wait for it.
  const uint32_t share = uint32_t((open_.size() + devices_ - 1) / devices_);
  const uint32_t most = std::min(share, std::max(1u, block_paths / unit.samples));
  for (size_t i = *first; i < open_.size() && unit.blocks.size() < most; ++i) {
    Block& b = blocks_[open_[i]];
    if (b.busy || b.done != like.done || b.owner != like.owner) continue;
    b.busy = true;
    if (b.owner != device && b.owner != kNobody) unit.elsewhere.emplace_back(open_[i], b.owner);
    b.owner = device;
    unit.blocks.push_back(open_[i]);
  }
  // The last blocks of a round must not get far ahead when the end may come at any time.
  if (in_a_hurry_ && unit.blocks.size() < share) return unit;
  // What is left of the wave goes to more samples, up to a whole round of the scrambles; with several devices in steps
  // that still let them share the rest.
  const auto whole = [&](uint32_t samples) {
    const uint32_t end = (like.done + samples) / even * even;
    return end > like.done ? end - like.done : 0;
  };
  const uint32_t fit = whole(block_paths / uint32_t(unit.blocks.size()));
  const uint32_t fair = devices_ > 1 ? whole(left / 4) : left;
  unit.samples = std::max(unit.samples, std::min({left, fit, fair}));
  return unit;
}

void WorkList::finish(const WorkUnit& unit) {
  {
    const std::lock_guard lock(mutex_);
    for (const uint32_t i : unit.blocks) {
      blocks_[i].done += unit.samples;
      blocks_[i].busy = false;
    }
    if (unit.first_sample + unit.samples == samples_)
      std::erase_if(open_, [&](uint32_t b) { return blocks_[b].done == samples_; });
    done_ += uint64_t(unit.blocks.size()) * unit.samples;
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

bool WorkList::stopped() const {
  const std::lock_guard lock(mutex_);
  return stopped_;
}

uint64_t WorkList::done() const {
  const std::lock_guard lock(mutex_);
  return done_;
}

uint64_t WorkList::asked() const {
  const std::lock_guard lock(mutex_);
  return asked_;
}

bool WorkList::all_begun() const {
  const std::lock_guard lock(mutex_);
  return std::all_of(blocks_.begin(), blocks_.end(), [](const Block& b) { return b.busy || b.done > 0; });
}

uint32_t WorkList::samples(uint32_t block) const {
  const std::lock_guard lock(mutex_);
  return blocks_[block].done;
}

std::optional<uint32_t> WorkList::owner(uint32_t block) const {
  const std::lock_guard lock(mutex_);
  if (blocks_[block].owner == kNobody) return {};
  return blocks_[block].owner;
}

}  // namespace wale
