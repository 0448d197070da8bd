#pragma once
#include <algorithm>
#include <chrono>
#include <mutex>

namespace wale {

/// Lets `burst` events through at once and `rate` a second in the long run (token bucket). Any thread may ask.
class RateLimit {
 public:
  using Clock = std::chrono::steady_clock;
  RateLimit(double rate, double burst) : rate_(rate), burst_(burst), left_(burst) {}

  bool allow(Clock::time_point now = Clock::now()) {
    const std::lock_guard lock(mutex_);
    left_ = std::min(burst_, left_ + rate_ * std::max(0.0, std::chrono::duration<double>(now - last_).count()));
    last_ = std::max(last_, now);
    if (left_ < 1) return false;
    left_ -= 1;
    return true;
  }

 private:
  double rate_, burst_, left_;
  Clock::time_point last_ = Clock::now();
  std::mutex mutex_;
};

}  // namespace wale
