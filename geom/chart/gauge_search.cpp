#include "geom/chart/gauge_search.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

namespace wale {
namespace {

// Where a gauge may be reached, from loop lengths that were tried: between the nearest ones on both sides of it, else
// on along the slope of the two nearest, else in proportion, as a stitch grows with its loop.
double next_length(std::vector<dvec2> tried, double wanted) {  // (loop length, gauge)
  constexpr double kFlattest = -0.15, kSteepest = -2, kFarthest = 0.5;
  for (dvec2& t : tried) t = {std::log(t.x), std::log(t.y / wanted)};
  std::sort(tried.begin(), tried.end(), [](const dvec2& a, const dvec2& b) { return std::abs(a.y) < std::abs(b.y); });
  const dvec2 near = tried[0];
  for (const dvec2& t : tried)
    if (t.y * near.y < 0) return std::exp(near.x - near.y * (t.x - near.x) / (t.y - near.y));
  const double slope = tried.size() > 1 ? (tried[1].y - near.y) / (tried[1].x - near.x) : -1;
  return std::exp(near.x - std::clamp(near.y / std::clamp(slope, kSteepest, kFlattest), -kFarthest, kFarthest));
}

}  // namespace

// Where a loop jams it was too short. Where it ran out of steps, or got stuck, nobody knows: longer ones relax sooner,
// but one that is longer than another that came to rest only bars the way from that one.
KnittedTile knit_to_gauge(const KnitSettings& settings, const KnitOfLength& knit,
                          const std::function<bool(double)>& progress) {
  constexpr int kTries = 10;
  constexpr double kBracket = 1.02;
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double>(settings.max_seconds);
  const int axis = settings.wales ? 0 : 1;
  const double wanted = settings.wales ? *settings.wales : *settings.courses;
  const auto miss = [&](const KnittedTile& tile) { return std::abs(tile.gauge[axis] / wanted - 1); };
  double length = kPlainLoop, jams = 0, shortest = kLongestLoop;
  std::vector<double> unknown;  // lengths that failed, longer than one that came to rest
  std::vector<dvec2> tried;
  std::optional<KnittedTile> best;
  KnitSettings rest = settings;
  rest.starts = 1;
  int tries = 0;
  GaugeEnd why = GaugeEnd::none;
  for (;;) {
    if (tries > 0) rest.max_seconds = std::chrono::duration<double>(end - Clock::now()).count();
    if (rest.max_seconds <= 0) why = GaugeEnd::time;
    if (tries == kTries && why == GaugeEnd::none) why = GaugeEnd::tries;
    if (tries == kTries || why == GaugeEnd::time) break;
    KnittedTile tile =
        knit(length, rest, [&](double share) { return !progress || progress((tries + share) / kTries); });
    ++tries;
    if (tile.stopped) {
      tile.tries = tries;
      return tile;
    }
    double next = 1.3 * length;
    if (!tile.relaxed.converged) {
      if (tile.relaxed.end == RelaxEnd::steps) why = GaugeEnd::steps;
      if (tile.relaxed.end == RelaxEnd::stuck) why = GaugeEnd::stuck;
      if (tile.relaxed.end == RelaxEnd::time) why = GaugeEnd::time;
      if (tile.relaxed.end == RelaxEnd::jammed || length < shortest)
        jams = std::max(jams, length);
      else
        unknown.push_back(length);
      if (!tried.empty()) next = 0.5 * (length + best->loop_length / settings.yarn_thickness);
      if (tried.empty()) best = std::move(tile);
      if (why == GaugeEnd::time) break;
    } else {
      tried.emplace_back(length, tile.gauge[axis]);
      shortest = std::min(shortest, length);
      if (tried.size() == 1 || miss(tile) < miss(*best)) best = std::move(tile);
      if (miss(*best) <= kGaugeTolerance) break;
      next = next_length(tried, wanted);
    }
    next = std::clamp(next, std::max(kShortestLoop, jams), kLongestLoop);
    // Beyond a length that failed, as seen from every one that came to rest: half-way to it from the nearest in gauge.
    const auto barred = [&](double from) {
      return std::any_of(unknown.begin(), unknown.end(), [&](double f) { return (f - from) * (f - next) <= 0; });
    };
    bool near = false;
    if (!tried.empty() && std::all_of(tried.begin(), tried.end(), [&](const dvec2& t) { return barred(t.x); })) {
      const double from = best->loop_length / settings.yarn_thickness;
      for (const double failed : unknown)
        if ((failed - from) * (failed - next) <= 0) {
          next = std::sqrt(from * failed);
          near = std::max(from, failed) < kBracket * std::min(from, failed);
        }
    }
    if (near) break;
    // Where the loop would be one that jams, the shortest that does not is looked for, until the two are near.
    if (next < kBracket * jams && !tried.empty()) next = std::sqrt(jams * shortest);
    if (std::abs(next / length - 1) < 1e-4 || (!tried.empty() && next < kBracket * jams)) break;
    length = next;
  }
  best->tries = tries;
  best->gauge_end = best->relaxed.converged && miss(*best) <= kGaugeTolerance ? GaugeEnd::reached : why;
  return std::move(*best);
}

}  // namespace wale
