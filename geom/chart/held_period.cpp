#include "geom/chart/held_period.h"

#include <fmt/format.h>

#include <chrono>
#include <string>

#include "geom/chart/knit_once.h"

namespace wale {
namespace {

// As it is printed, so that it can be asked for.
double four_digits(double metres) { return std::stod(fmt::format("{:.4g}", 1e3 * metres)) / 1e3; }

}  // namespace

std::optional<dvec2> nearest_period(const StitchChart& chart, const KnitSettings& settings,
                                    const std::function<bool(double)>& progress) {
  constexpr int kHalvings = 6;
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double>(settings.max_seconds);
  const Knit knit = knit_chart(chart);
  const double diameters = loop_diameters_of(settings);
  KnitSettings trial = settings;
  int tries = 0;
  // Whether time or somebody ended it is seen by what it did not reach.
  const auto relaxed = [&](const std::optional<dvec2>& period) -> std::optional<dvec2> {
    trial.period = period;
    trial.max_seconds = std::chrono::duration<double>(end - Clock::now()).count();
    if (trial.max_seconds <= 0) return std::nullopt;
    const KnittedTile tile = knit_once(chart, knit, trial, diameters, [&](double share) {
      return !progress || progress((tries + share) / (kHalvings + 1));
    });
    ++tries;
    if (tile.stopped || tile.relaxed.end == RelaxEnd::time) trial.max_seconds = 0;
    return tile.relaxed.converged ? std::optional(tile.pattern.period) : std::nullopt;
  };
  const auto free = relaxed(std::nullopt);
  if (!free) return std::nullopt;
  std::optional<dvec2> best;
  double holds = 0, jams = 1;  // shares of the way
  for (int i = 0; i < kHalvings; ++i) {
    const double share = 0.5 * (holds + jams);
    const dvec2 between = glm::mix(*free, *settings.period, share);
    const dvec2 period(four_digits(between.x), four_digits(between.y));
    const auto reached = relaxed(period);
    if (trial.max_seconds <= 0) break;
    (reached ? holds : jams) = share;
    if (reached) best = period;
  }
  return best;
}

}  // namespace wale
