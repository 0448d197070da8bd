#include "geom/relax/starts.h"

#include <algorithm>
#include <mutex>

#include "geom/relax/step_bound.h"
#include "geom/run_tasks.h"

namespace wale {
namespace {

// SplitMix64 (Steele et al. 2014), which is the same with every standard library; in [-1, 1].
class Noise {
 public:
  explicit Noise(uint64_t seed) : state_(seed) {}
  double operator()() {
    uint64_t z = state_ += 0x9e3779b97f4a7c15ull;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return double((z ^ (z >> 31)) >> 11) * 0x1p-52 - 1;
  }
  dvec3 vector() {
    const double x = (*this)(), y = (*this)();
    return {x, y, (*this)()};
  }

 private:
  uint64_t state_;
};

}  // namespace

void shake(PeriodicYarns& yarns, double amplitude, double neighbours, uint64_t seed) {
  constexpr int kSmoothing = 6;
  const double diameter = 2 * yarns.radius, reach = 2 * diameter;
  Noise noise(seed);
  TileStep step;
  for (size_t i = 0; i < yarns.points.size(); ++i) step.points.push_back(amplitude * diameter * noise.vector());
  for (int turn = 0; turn < kSmoothing; ++turn) {
    const std::vector<dvec3> before = step.points;
    for (const PeriodicYarn& yarn : yarns.yarns)
      for (uint32_t i = 0; i < yarn.count; ++i)
        step.points[yarn.first + i] =
            0.5 * before[yarn.first + i] +
            0.25 * (before[yarn.first + (i + yarn.count - 1) % yarn.count] + before[yarn.first + (i + 1) % yarn.count]);
  }
  step.strain = 0.5 * amplitude * dvec2(noise.vector());
  const std::vector<YarnSegment> segments = segments_of(yarns);
  const auto near = near_pairs(yarns, segments, reach, neighbours * diameter);
  yarns = moved(yarns, step, safe_share(yarns, segments, near, reach, 0, step));
}

Relaxed relax_from_starts(PeriodicYarns& yarns, const RelaxSettings& settings, int starts, unsigned threads,
                          const std::function<bool(int, double, double)>& progress) {
  constexpr double kShaken = 0.2;
  struct Try {
    PeriodicYarns yarns;
    Relaxed reached;
  };
  // One end for all: the last starts begin when the first ones are done.
  RelaxSettings timed = settings;
  timed.until = end_of(settings);
  std::vector<Try> tries(size_t(std::max(starts, 1)), {yarns, {}});
  std::vector<size_t> open;
  for (size_t i = tries.size(); i-- > 0;) open.push_back(i);
  std::mutex telling;
  bool go_on = true;
  run_tasks(threads, open, [&](size_t i, const auto&) {
    if (i > 0 && std::chrono::steady_clock::now() > timed.until) {
      tries[i].reached.end = RelaxEnd::time;
      return;
    }
    RelaxSettings own = timed;
    own.path += i;
    if (i > 0) {
      if (own.watch) own.watch(own.path, in_diameters(tries[i].yarns));
      shake(tries[i].yarns, kShaken, settings.neighbours, i);
    }
    tries[i].reached = relax(tries[i].yarns, own, [&](double share, double force) {
      const std::lock_guard lock(telling);
      return go_on = go_on && (!progress || progress(int(i), share, force));
    });
  });
  const auto better = [](const Try& a, const Try& b) {
    if (a.reached.converged != b.reached.converged) return a.reached.converged;
    if ((a.reached.steps > 0) != (b.reached.steps > 0)) return a.reached.steps > 0;  // the others had no time to begin
    return a.reached.energy < b.reached.energy;
  };
  Try& best = *std::min_element(tries.begin(), tries.end(), better);
  // Which starts came to their end in time hangs on the machine, and so would the lowest of them.
  for (const Try& one : tries)
    if (one.reached.end == RelaxEnd::time) best.reached.converged = false, best.reached.end = RelaxEnd::time;
  yarns = std::move(best.yarns);
  return best.reached;
}

}  // namespace wale
