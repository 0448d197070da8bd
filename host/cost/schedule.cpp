#include "host/cost/schedule.h"

#include <algorithm>
#include <cmath>

#include "host/cost/bias.h"
#include "host/film.h"

namespace wale::cost {
namespace {

constexpr int kMostSamples = 1 << 16;

int whole_scrambles(double samples) {
  const double least = double(kScrambles), most = kMostSamples;
  return int(std::floor(std::clamp(samples, least, most) / least)) * int(kScrambles);
}

double middle(std::vector<double> values) {
  const auto at = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// Seconds of one repetition of all that are not left out.
double cycle(std::span<const UnitPrice> prices, const std::vector<int>& samples) {
  double sum = 0;
  for (size_t u = 0; u < prices.size(); ++u)
    if (samples[u]) sum += samples[u] * prices[u].seconds_per_sample + prices[u].seconds_per_visit;
  return sum;
}

// Samples of every unit when those of common price have `common`.
std::vector<int> samples_at(std::span<const UnitPrice> prices, const std::vector<bool>& kept, double common,
                            double dear) {
  std::vector<int> out(prices.size(), 0);
  for (size_t u = 0; u < prices.size(); ++u)
    if (kept[u]) out[u] = whole_scrambles(common * std::min(1.0, dear / std::max(prices[u].seconds_per_sample, 1e-30)));
  return out;
}

}  // namespace

double least_seconds(std::span<const UnitPrice> prices) {
  double sum = 0;
  for (const UnitPrice& p : prices)
    if (p.needed) sum += kFewestRepetitions * (kScrambles * p.seconds_per_sample + p.seconds_per_visit);
  return sum;
}

RunPlan plan_runs(std::span<const UnitPrice> prices, double seconds, int most_repetitions) {
  RunPlan plan;
  plan.samples.assign(prices.size(), 0);
  plan.predicted.assign(prices.size(), 0);
  if (prices.empty() || least_seconds(prices) > seconds) return plan;
  std::vector<double> each;
  for (const UnitPrice& p : prices) each.push_back(p.seconds_per_sample);
  const double dear = kDearest * middle(each);
  std::vector<bool> kept(prices.size(), true);
  // The dearest goes first, as it leaves most to the others.
  const auto visit = [&](size_t u) { return kScrambles * prices[u].seconds_per_sample + prices[u].seconds_per_visit; };
  while (kFewestRepetitions * cycle(prices, samples_at(prices, kept, 0, dear)) > seconds) {
    std::optional<size_t> dearest;
    for (size_t u = 0; u < prices.size(); ++u)
      if (kept[u] && !prices[u].needed && (!dearest || visit(u) > visit(*dearest))) dearest = u;
    if (!dearest) return plan;
    kept[*dearest] = false;
  }
  plan.repetitions = std::min(std::max(int(seconds / kLongestRound), kWantedRepetitions), most_repetitions);
  while (plan.repetitions > kFewestRepetitions &&
         plan.repetitions * cycle(prices, samples_at(prices, kept, 0, dear)) > seconds)
    --plan.repetitions;
  double low = 0, high = kMostSamples;  // of samples that fit, and that may not
  for (int step = 0; step < 40; ++step) {
    const double half = 0.5 * (low + high);
    (plan.repetitions * cycle(prices, samples_at(prices, kept, half, dear)) <= seconds ? low : high) = half;
  }
  plan.samples = samples_at(prices, kept, low, dear);
  plan.most_repetitions = std::max(plan.repetitions, most_repetitions);
  for (size_t u = 0; u < prices.size(); ++u)
    if (plan.samples[u])
      plan.predicted[u] = plan.samples[u] * prices[u].seconds_per_sample + prices[u].seconds_per_visit;
  return plan;
}

bool run_interleaved(const RunPlan& plan, double deadline, const Clock& clock,
                     const std::function<bool(size_t, int, int)>& render) {
  double planned = 0, taken = 0;
  for (int repetition = 0; repetition < std::max(plan.repetitions, plan.most_repetitions); ++repetition)
    for (size_t u = 0; u < plan.samples.size(); ++u) {
      if (plan.samples[u] == 0) continue;
      const double begun = clock(), slower = planned > 0 ? taken / planned : 1;
      if (begun + plan.predicted[u] * slower > deadline) return repetition >= plan.repetitions;
      if (!render(u, repetition, plan.samples[u])) return false;
      planned += plan.predicted[u];
      taken += clock() - begun;
    }
  return true;
}

}  // namespace wale::cost
