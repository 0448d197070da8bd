#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "host/fit/rounds.h"

namespace wale::fit {

/// One render's residuals at x, with all derivatives; renders of different numbers are independent.
using RenderRound = std::function<Replicate(std::span<const double> x, int samples, uint32_t number)>;
/// Told after every round but the first of a place: where, and the loss there so far.
using PolishProgress = std::function<void(std::span<const double> x, double loss)>;

struct Polished {
  std::vector<double> x;
  ParameterErrors errors;
  bool converged = false;  ///< steps became as short as their errors, and none was left out
};

/// Makes the end of a descent surer: three places, at each several rounds of renders and one step, the next with more
/// samples; the first is repeated while steps are longer than their errors. `samples`: paths a pixel of the rounds of
/// three places together. `cells`: of each residual (Rounds). `stop`: ends it between rounds, after a few of them with
/// what they give.
Polished polish(const RenderRound& render, std::vector<double> x, int samples, std::span<const int> cells,
                const std::function<bool()>& stop, const PolishProgress& progress);

}  // namespace wale::fit
