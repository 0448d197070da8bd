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
        asked_(blocks, true),
        share(seconds_.size(), 0) {}

  void run() {
    left_ = size_t(samples_) * done_.size();
    work();
    EXPECT_EQ(left_, 0u);
    for (uint32_t b = 0; b < done_.size(); ++b) EXPECT_EQ(done_[b], samples_);
  }

  /// Asks for more samples of some blocks and works until that is done.
  void pass(const std::vector<uint32_t>& blocks, uint32_t samples) {
    samples_ = samples;
    left_ = 0;
    for (const uint32_t b : blocks) left_ += samples - done_[b];
    asked_.assign(done_.size(), false);
    for (const uint32_t b : blocks) asked_[b] = true;
    list_.ask(blocks, samples);
    work();
    EXPECT_EQ(left_, 0u);
    for (const uint32_t b : blocks) EXPECT_EQ(done_[b], samples);
  }

  uint32_t done(uint32_t block) const { return done_[block]; }

 private:
  void work() {
    struct Running {
      double ends;
      uint32_t device;
      WorkUnit unit;
    };
    std::vector<Running> running;
    std::vector<bool> idle(seconds_.size(), true);
    double now = 0;
    while (true) {
      // A device asks only when a block is free for it: this simulation has one thread, which must not wait.
      for (uint32_t d = 0; d < seconds_.size(); ++d)
        if (idle[d] && free_block()) {
          const auto unit = list_.take(d, paths_, kBlockPixels, kEven);
          ASSERT_TRUE(unit);
          check(d, *unit);
          const double cost = double(unit->blocks.size()) * kBlockPixels * unit->samples * seconds_[d];
          running.push_back({now + cost, d, *unit});
          idle[d] = false;
        }
      if (running.empty()) break;
      const auto next = std::min_element(running.begin(), running.end(),
                                         [](const auto& a, const auto& b) { return a.ends < b.ends; });
      now = next->ends;
      for (const uint32_t b : next->unit.blocks) {
        done_[b] += next->unit.samples;
        busy_.erase(std::find(busy_.begin(), busy_.end(), b));
        left_ -= next->unit.samples;
      }
      waves.push_back(uint32_t(next->unit.blocks.size()) * next->unit.samples);
      share[next->device] += uint64_t(next->unit.blocks.size()) * next->unit.samples;
      idle[next->device] = true;
      list_.finish(next->unit);
      running.erase(next);
    }
    EXPECT_TRUE(list_.complete());
    for (uint32_t b = 0; b < done_.size(); ++b) {
      EXPECT_EQ(list_.samples(b), done_[b]);
      if (done_[b]) {
        EXPECT_EQ(list_.owner(b), at_[b]);
      }
    }
    seconds = now;
  }

 public:
  static constexpr uint32_t kBlockPixels = 64;
  double seconds = 0;
  std::vector<uint32_t> waves;   ///< blocks times samples of every unit
  size_t moved = 0, spread = 0;  ///< blocks taken over; largest distance between two blocks, in samples

 private:
  static constexpr uint32_t kNowhere = 99;
  bool free_block() const {
    for (uint32_t b = 0; b < done_.size(); ++b)
      if (asked_[b] && done_[b] < samples_ && std::find(busy_.begin(), busy_.end(), b) == busy_.end()) return true;
    return false;
  }

  void check(uint32_t device, const WorkUnit& unit) {
    ASSERT_GE(unit.blocks.size(), 1u);
    ASSERT_TRUE(std::is_sorted(unit.blocks.begin(), unit.blocks.end()));
    ASSERT_GE(unit.samples, 1u);
    ASSERT_LE(unit.first_sample + unit.samples, samples_);
    ASSERT_LE(uint64_t(unit.blocks.size()) * kBlockPixels * unit.samples, std::max(paths_, kBlockPixels));
    for (const uint32_t b : unit.blocks) {
      ASSERT_TRUE(asked_[b]) << "a block that nobody asked for";
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
  std::vector<bool> asked_;
  size_t left_ = 0;

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
  EXPECT_EQ(unit->blocks, (std::vector<uint32_t>{0, 1})) << "the other half is the other device's";
  EXPECT_EQ(unit->samples, 248u) << "a quarter, in whole rounds of scrambles: the rest can still be shared";
}

TEST(WorkList, BlocksThatGoOnAreGatheredIntoFullWaves) {
  for (const auto& devices : {std::vector<double>{1}, {1, 1}, {1, 7, 3}}) {
    Simulation s(64, 0, devices, 4 * 64 * 8);
    std::vector<uint32_t> all(64), few;
    for (uint32_t b = 0; b < 64; ++b) all[b] = b;
    for (uint32_t b = 1; b < 64; b += 5) few.push_back(b);  // no two of them are neighbours
    s.pass(all, 16);
    s.waves.clear();
    s.pass(few, 24);
    if (devices.size() == 1) {
      EXPECT_EQ(s.waves, (std::vector<uint32_t>{32, 32, 32, 8}));
    }
    s.pass({7, 62}, 1000);
    for (uint32_t b = 0; b < 64; ++b) EXPECT_EQ(s.done(b), b == 7 || b == 62 ? 1000u : b % 5 == 1 ? 24u : 16u) << b;
  }
}

TEST(WorkList, InAHurryEveryBlockIsBegunFirst) {
  WorkList list(10, 1000, 1, true);
  std::vector<uint32_t> done(10);
  const auto next = [&](uint32_t blocks_of_paths) {
    const auto unit = list.take(0, blocks_of_paths * 64, 64, kEven);
    for (const uint32_t b : unit->blocks) done[b] += unit->samples;
    list.finish(*unit);
  };
  for (int i = 0; i < 3; ++i) {
    EXPECT_FALSE(list.all_begun());
    next(4);
  }
  EXPECT_TRUE(list.all_begun());
  EXPECT_EQ(done, std::vector<uint32_t>(10, 1)) << "the last wave was not filled with one block's samples";
  while (done.back() < 8) next(40);
  EXPECT_EQ(done, std::vector<uint32_t>(10, 8));
  for (int i = 0; i < 40; ++i) {
    next(3);
    const auto [lo, hi] = std::minmax_element(done.begin(), done.end());
    EXPECT_LE(*hi - *lo, kEven);
  }
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
