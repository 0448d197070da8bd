#include "host/fit/polish.h"

#include <algorithm>
#include <cmath>

namespace wale::fit {
namespace {

constexpr double kShares[] = {1.0 / 8, 1.0 / 8, 3.0 / 4};  // of the samples
constexpr int kFirstPlaces = 8;
constexpr int kRounds = 8, kLeastRounds = 3;
constexpr double kReach = 0.15;  // lines tell no further
constexpr double kToItsEnd = 0.999 * kReach;
constexpr double kDeviations = 3;  // that a step may go where all is well
constexpr double kLeastStep = 2e-2;

// Whether a step is as short as its errors are; where these are not known, whether it ended before its reach.
bool short_step(std::span<const double> from, const Rounds::Step& step) {
  for (size_t k = 0; k < from.size(); ++k) {
    const double allowed = step.errors.too_few_cells
                               ? kToItsEnd
                               : std::max(kLeastStep, kDeviations * step.errors.deviations[k].value_or(1.0));
    if (std::abs(step.x[k] - from[k]) > allowed) return false;
  }
  return true;
}

// Whether nothing that is known wanted to go farther.
bool within_reach(std::span<const double> from, const Rounds::Step& step) {
  for (size_t k = 0; k < from.size(); ++k)
    if (std::abs(step.x[k] - from[k]) > kToItsEnd && step.errors.deviations[k].value_or(1.0) < kReach / kDeviations)
      return false;
  return true;
}

}  // namespace

Polished polish(const RenderRound& render, std::vector<double> x, int samples, std::span<const int> cells,
                const std::function<bool()>& stop, const PolishProgress& progress) {
  Polished out;
  uint32_t number = 0;
  int places = 0;
  size_t share = 0;
  bool settled = false, cut = false;
  while (share < std::size(kShares) && (out.x.empty() || !stop())) {
    Rounds rounds(cells);
    while (rounds.count() < kRounds && (rounds.count() < kLeastRounds || !stop())) {
      rounds.add(render(x, std::max(1, int(std::lround(kShares[share] * samples / kRounds))), number++));
      if (rounds.count() > 1) progress(x, rounds.loss());
    }
    cut |= rounds.count() < kRounds;
    const Rounds::Step step = rounds.solve(x, kReach);
    // Where the descent ended far off, a few samples lead on before more are spent. Later steps may be longer than
    // their errors: they mend those of few samples.
    settled = share == 0 ? short_step(x, step) : settled && within_reach(x, step);
    if (settled || ++places >= kFirstPlaces || share > 0) ++share;
    out.x = x = step.x;
    out.errors = step.errors;
  }
  out.converged = settled && !cut && share == std::size(kShares);
  return out;
}

}  // namespace wale::fit
