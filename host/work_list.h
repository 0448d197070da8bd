#pragma once
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

namespace wale {

/// Blocks of pixels and a run of their samples, which one device traces next.
struct WorkUnit {
  std::vector<uint32_t> blocks;  ///< ascending
  uint32_t first_sample = 0, samples = 0;
  /// Blocks of the unit whose sums so far lie on another device, and on which one.
  std::vector<std::pair<uint32_t, uint32_t>> elsewhere;
};

/// Shares the samples of a picture between devices, each at its own pace. A block belongs to one device at a time and
/// takes its sums along when it changes hands, so that every pixel's samples are added in their order, to the same
/// floats, whoever traces them: the picture does not depend on the number of devices.
///
/// The block that is farthest behind is handed out first, to its own device rather than to another; a device that is
/// ahead takes blocks away from those that are behind.
class WorkList {
 public:
  /// Asks for so many samples of every block. `in_a_hurry`: the first sample of every block comes before any block's
  /// second, however many waves that takes: whoever stops soon has a whole picture.
  WorkList(uint32_t blocks, uint32_t samples, uint32_t devices, bool in_a_hurry = false);

  /// Asks that these blocks be brought to so many samples, when all that was asked before is done and nobody works.
  void ask(std::vector<uint32_t> blocks, uint32_t samples);

  /// The next unit for a device: at most `paths` = blocks * block_pixels * samples of it, but one block and one sample
  /// at least. Up to `even` samples (one of every scramble) keep the picture even; more are handed out only where they
  /// would not fill a wave. Waits while all blocks that need samples are being traced by others. Nothing when what was
  /// asked is done or somebody called stop().
  std::optional<WorkUnit> take(uint32_t device, uint32_t paths, uint32_t block_pixels, uint32_t even);
  void finish(const WorkUnit& unit);
  void stop();
  bool stopped() const;

  /// Samples done, of all blocks together, and those asked for so far.
  uint64_t done() const;
  uint64_t asked() const;
  bool complete() const { return done() == asked(); }
  /// No block is without a sample, those counted that are being traced.
  bool all_begun() const;
  uint32_t samples(uint32_t block) const;
  /// Device that holds a block's sums; none before its first sample.
  std::optional<uint32_t> owner(uint32_t block) const;

 private:
  static constexpr uint32_t kNobody = 0xffffffffu;
  struct Block {
    uint32_t done = 0;  ///< samples
    uint32_t owner = kNobody;
    bool busy = false;
  };
  std::optional<size_t> farthest_behind(uint32_t device) const;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Block> blocks_;
  std::vector<uint32_t> open_;  ///< blocks with fewer samples than asked, ascending
  uint32_t samples_ = 0, devices_;
  uint64_t done_ = 0, asked_ = 0;
  bool in_a_hurry_, stopped_ = false;
};

}  // namespace wale
