#pragma once
#include <cstdint>
#include <vector>

namespace wale {

/// Which tiles go on sampling, and how far: `wale render --error`. All tiles that are open have the same number of
/// samples; a tile is judged only when it has reached a checkpoint, by the sums that it has there, so that the decision
/// depends on its own samples alone. Few checkpoints, 1.4 apart in noise or less, keep what stopping adds to the bias
/// small (each judgement is one more chance to stop on a lucky estimate) and waste less than half a tile's samples.
class ErrorGoal {
 public:
  /// `error` > 0: relative error at which a tile stops (host/tile_error.h); `limit`: most samples per pixel.
  ErrorGoal(double error, uint32_t limit, uint32_t tiles);

  /// Tiles that have not reached the goal, ascending; empty when there is nothing more to do.
  const std::vector<uint32_t>& open() const { return open_; }
  /// Samples that they are to be brought to next.
  uint32_t checkpoint() const { return checkpoint_; }
  /// Errors of the open tiles at that checkpoint, in their order: those at the goal stop, the others go on.
  void judge(const std::vector<double>& errors);

  /// Samples of all tiles together that the goal will take from here on, as far as the last errors tell.
  double expected() const { return expected_; }

 private:
  double error_, expected_ = 0;
  uint32_t limit_, checkpoint_;
  std::vector<uint32_t> open_;
};

/// The checkpoint after `samples`: 16, 24, 32, 48, 64, 96 ... up to `limit`. Whole rounds of the eight scrambles, whose
/// points are then a power of two or a power and its half, where Sobol points are even.
uint32_t next_checkpoint(uint32_t samples, uint32_t limit);

}  // namespace wale
