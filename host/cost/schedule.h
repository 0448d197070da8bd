#pragma once
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace wale::cost {

/// What a first short render of a picture taught about its price.
struct UnitPrice {
  double seconds_per_sample = 0;  ///< of every pixel, wall
  double seconds_per_visit = 0;   ///< that each repetition takes beside, where its geometry is not kept
  bool needed = false;            ///< without it nothing can be compared: the base and the reference
};

/// How often each picture is rendered, and with how many samples.
struct RunPlan {
  int repetitions = 0;            ///< that the time is sure to allow
  int most_repetitions = 0;       ///< that are made where time is left
  std::vector<int> samples;       ///< per unit, of every pixel and repetition, multiples of kScrambles; 0: left out
  std::vector<double> predicted;  ///< per unit, seconds of one repetition
};

constexpr int kWantedRepetitions = 8, kMostRepetitions = 32;
constexpr double kLongestRound = 30;  ///< seconds of one repetition of all, where so many repetitions are enough

/// Shares `seconds` among the units. All get the same samples, but those that cost more than kDearest times the middle
/// one fewer. Where even kFewestRepetitions of the fewest samples take too long, the dearest are left out until the
/// rest fits. Time that is left over goes to more repetitions. No repetitions where the needed ones alone do not fit.
RunPlan plan_runs(std::span<const UnitPrice> prices, double seconds, int most_repetitions = kMostRepetitions);
constexpr double kDearest = 4;

/// Least seconds in which the needed units could be measured.
double least_seconds(std::span<const UnitPrice> prices);

/// Seconds since it was made, by the wall's clock or a test's.
using Clock = std::function<double()>;

/// Renders unit after unit, then all of them again, so that what disturbs the machine disturbs all alike. A repetition
/// that by the plan, corrected by what earlier ones took, would end after `deadline` (by the clock) is not begun, nor
/// any after it. `render(unit, repetition, samples)` returns false when the user asked for an end.
/// Returns true when the plan's repetitions were done.
bool run_interleaved(const RunPlan& plan, double deadline, const Clock& clock,
                     const std::function<bool(size_t unit, int repetition, int samples)>& render);

}  // namespace wale::cost
