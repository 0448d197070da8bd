// Devices that share a render, without devices: who gets what, in which order, and where the sums lie.
#include "host/work_list.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <future>
#include <random>

namespace wale::test {
namespace {

constexpr uint32_t kEven = 8;  // one sample of every scramble

/// Devices with a time per path each, run on one clock. Checks every unit that is handed out.
class Simulation {
 public:
  Simulation(uint32_t blocks, uint32_t samples, std::vector<double> seconds_per_path, uint32_t paths)
      : list_(blocks, samples, uint32_t(seconds_per_path.size())),
        seconds_(std::move(seconds_per_path)),
        paths_(paths),
        samples_(samples),
        at_(blocks, kNowhere),
        done_(blocks, 0),
        share(seconds_.size(), 0) {}

  void run() {
    struct Running {
      double ends;
      uint32_t device;
      WorkUnit unit;
    };
    std::vector<Running> running;
    std::vector<bool> idle(seconds_.size(), true);
    double now = 0;
    size_t left = size_t(samples_) * done_.size();
    while (true) {
      // A device asks only when a block is free for it: this simulation has one thread, which must not wait.
      for (uint32_t d = 0; d < seconds_.size(); ++d)
        if (idle[d] && free_block()) {
          const auto unit = list_.take(d, paths_, kBlockPixels, kEven);
          ASSERT_TRUE(unit);
          check(d, *unit);
          const double cost = double(unit->blocks) * kBlockPixels * unit->samples * seconds_[d];
          running.push_back({now + cost, d, *unit});
          idle[d] = false;
        }
      if (running.empty()) break;
      const auto next = std::min_element(running.begin(), running.end(),
                                         [](const auto& a, const auto& b) { return a.ends < b.ends; });
      now = next->ends;
      for (uint32_t b = next->unit.first_block; b < next->unit.first_block + next->unit.blocks; ++b) {
        done_[b] += next->unit.samples;
        busy_.erase(std::find(busy_.begin(), busy_.end(), b));
        left -= next->unit.samples;
      }
      share[next->device] += uint64_t(next->unit.blocks) * next->unit.samples;
      idle[next->device] = true;
      list_.finish(next->unit);
      running.erase(next);
    }
    EXPECT_EQ(left, 0u);
    EXPECT_TRUE(list_.complete());
    EXPECT_EQ(list_.most_samples(), samples_);
    for (uint32_t b = 0; b < done_.size(); ++b) {
      EXPECT_EQ(done_[b], samples_);
      EXPECT_EQ(list_.owner(b), at_[b]);
    }
    seconds = now;
  }

  static constexpr uint32_t kBlockPixels = 64;
  double seconds = 0;
  size_t moved = 0, spread = 0;  ///< blocks taken over; largest distance between two blocks, in samples

 private:
  static constexpr uint32_t kNowhere = 99;
  bool free_block() const {
    for (uint32_t b = 0; b < done_.size(); ++b)
      if (done_[b] < samples_ && std::find(busy_.begin(), busy_.end(), b) == busy_.end()) return true;
    return false;
  }

  void check(uint32_t device, const WorkUnit& unit) {
    ASSERT_GE(unit.blocks, 1u);
    ASSERT_GE(unit.samples, 1u);
    ASSERT_LE(unit.first_sample + unit.samples, samples_);
    ASSERT_LE(uint64_t(unit.blocks) * kBlockPixels * unit.samples, std::max(paths_, kBlockPixels));
    for (uint32_t b = unit.first_block; b < unit.first_block + unit.blocks; ++b) {
      ASSERT_EQ(done_[b], unit.first_sample) << "samples of a block are traced in their order, none twice";
      ASSERT_EQ(std::find(busy_.begin(), busy_.end(), b), busy_.end()) << "a block is on one device at a time";
      const auto told = std::find(unit.elsewhere.begin(), unit.elsewhere.end(), std::pair(b, at_[b]));
      ASSERT_EQ(told != unit.elsewhere.end(), at_[b] != kNowhere && at_[b] != device)
          << "sums lie where they are said to";
      moved += told != unit.elsewhere.end();
      at_[b] = device;
      busy_.push_back(b);
    }
    const auto [lo, hi] = std::minmax_element(done_.begin(), done_.end());
    spread = std::max<size_t>(spread, *hi - *lo);
  }

  WorkList list_;
  std::vector<double> seconds_;
  uint32_t paths_, samples_;
  std::vector<uint32_t> at_, done_, busy_;

 public:
  std::vector<uint64_t> share;  ///< blocks times samples, per device
};

TEST(WorkList, OneDeviceTracesEverythingInFullWaves) {
  Simulation s(40, 64, {1}, 4 * 64 * 8);
  s.run();
  EXPECT_EQ(s.moved, 0u);
  EXPECT_LE(s.spread, kEven);
}

TEST(WorkList, LikeDevicesShareAlikeAndMoveNothing) {
  Simulation s(40, 64, {1, 1}, 64 * 8);
  s.run();
  EXPECT_EQ(s.share[0], s.share[1]);
  EXPECT_EQ(s.moved, 0u);
}

TEST(WorkList, EachDeviceAtItsOwnPace) {
  // Ten times as fast: ten elevenths of the work, within a unit of each, and nobody waits long for the slow one's last.
  Simulation s(40, 256, {1, 10}, 64 * 8);
  s.run();
  const double all = 40.0 * 256, ideal = all * 64 / (1 + 0.1);
  EXPECT_NEAR(double(s.share[0]), all * 10 / 11, 0.02 * all);
  EXPECT_LT(s.seconds, ideal + 2 * 64 * 8 * 10);
  EXPECT_GT(s.moved, 0u);
}

TEST(WorkList, AnyDevicesAndSizes) {
  std::mt19937 random(7);
  for (int round = 0; round < 300; ++round) {
    const auto pick = [&](uint32_t lo, uint32_t hi) { return std::uniform_int_distribution<uint32_t>(lo, hi)(random); };
    std::vector<double> seconds(pick(1, 5));
    for (double& s : seconds) s = std::exp2(pick(0, 10));
    Simulation s(pick(1, 50), pick(1, 70), seconds, pick(64, 20000));
    s.run();
    if (HasFatalFailure()) FAIL() << "round " << round;
  }
}

TEST(WorkList, LargePoolsTakeMoreSamplesOfSmallPictures) {
  WorkList alone(4, 1000, 1);
  EXPECT_EQ(alone.take(0, 4 * 64 * 48, 64, kEven)->samples, 48u);
  WorkList shared(4, 1000, 2);
  const auto unit = shared.take(0, 1 << 20, 64, kEven);
  EXPECT_EQ(unit->blocks, 2u) << "the other half is the other device's";
  EXPECT_EQ(unit->samples, 248u) << "a quarter, in whole rounds of scrambles: the rest can still be shared";
}

TEST(WorkList, WhoWaitsIsWoken) {
  for (const bool stop : {false, true}) {
    WorkList list(1, 16, 2);
    const auto unit = list.take(0, 64 * 8, 64, kEven);
    ASSERT_TRUE(unit);
    auto other = std::async(std::launch::async, [&] { return list.take(1, 64 * 8, 64, kEven); });
    EXPECT_EQ(other.wait_for(std::chrono::milliseconds(20)), std::future_status::timeout) << "the only block is taken";
    if (stop)
      list.stop();
    else
      list.finish(*unit);
    const auto next = other.get();
    ASSERT_EQ(next.has_value(), !stop);
    if (!next) continue;
    EXPECT_EQ(next->first_sample, 8u);
    EXPECT_EQ(next->elsewhere, (std::vector<std::pair<uint32_t, uint32_t>>{{0, 0}}));
    list.finish(*next);
    EXPECT_FALSE(list.take(0, 64 * 8, 64, kEven)) << "done";
  }
}

}  // namespace
}  // namespace wale::test
