#pragma once
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

namespace wale {

/// A run of neighbouring blocks of pixels and a run of their samples, which one device traces next.
struct WorkUnit {
  uint32_t first_block = 0, blocks = 0;
  uint32_t first_sample = 0, samples = 0;
  /// Blocks of the run whose sums so far lie on another device, and on which one.
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
  WorkList(uint32_t blocks, uint32_t samples, uint32_t devices);

  /// The next unit for a device: at most `paths` = blocks * block_pixels * samples of it, but one block and one sample
  /// at least. Up to `even` samples (one of every scramble) keep the picture even; more are handed out only where they
  /// would not fill a wave. Waits while all blocks that need samples are being traced by others. Nothing when the
  /// picture is done or somebody called stop().
  std::optional<WorkUnit> take(uint32_t device, uint32_t paths, uint32_t block_pixels, uint32_t even);
  void finish(const WorkUnit& unit);
  void stop();

  /// Samples done, over all that are to be done.
  double fraction() const;
  bool complete() const { return fraction() >= 1; }
  /// Largest number of samples that a block has.
  uint32_t most_samples() const;
  /// Device that holds a block's sums; none before its first sample.
  std::optional<uint32_t> owner(uint32_t block) const;

 private:
  static constexpr uint32_t kNobody = 0xffffffffu;
  struct Block {
    uint32_t done = 0;  ///< samples
    uint32_t owner = kNobody;
    bool busy = false;
  };
  std::optional<uint32_t> farthest_behind(uint32_t device) const;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Block> blocks_;
  uint32_t samples_, devices_;
  uint64_t done_ = 0;
  bool stopped_ = false;
};

}  // namespace wale
