#include "host/error_goal.h"

#include <algorithm>
#include <numeric>

namespace wale {
namespace {

// Two points of every scramble: one alone tells little of noise that rare bright paths make.
constexpr uint32_t kFirstCheckpoint = 16;

}  // namespace

uint32_t next_checkpoint(uint32_t samples, uint32_t limit) {
  uint64_t power = kFirstCheckpoint;
  while (power * 2 <= samples) power *= 2;
  const uint64_t next = samples < power ? power : samples < power + power / 2 ? power + power / 2 : power * 2;
  return uint32_t(std::min<uint64_t>(next, limit));
}

ErrorGoal::ErrorGoal(double error, uint32_t limit, uint32_t tiles)
    : error_(error), limit_(limit), checkpoint_(next_checkpoint(0, limit)), open_(tiles) {
  std::iota(open_.begin(), open_.end(), 0u);
  expected_ = double(tiles) * checkpoint_;
}

void ErrorGoal::judge(const std::vector<double>& errors) {
  const bool last = checkpoint_ >= limit_;
  std::vector<uint32_t> on;
  expected_ = 0;
  for (size_t i = 0; i < open_.size(); ++i) {
    if (last || errors[i] <= error_) continue;
    on.push_back(open_[i]);
    const double ratio = errors[i] / error_, needed = checkpoint_ * ratio * ratio;  // noise falls as 1 / sqrt(samples)
    expected_ += std::min(needed, double(limit_)) - checkpoint_;
  }
  open_ = std::move(on);
  if (!open_.empty()) checkpoint_ = next_checkpoint(checkpoint_, limit_);
}

}  // namespace wale
