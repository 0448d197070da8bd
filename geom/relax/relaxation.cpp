#include "geom/relax/relaxation.h"

#include <algorithm>
#include <cmath>

#include "geom/relax/descent.h"
#include "geom/relax/step_bound.h"

namespace wale {
namespace {

constexpr double kSoft = 0.6;

}  // namespace

Relaxed relax(PeriodicYarns& yarns, const RelaxSettings& settings,
              const std::function<bool(double, double)>& progress) {
  const double diameter = 2 * yarns.radius;
  PeriodicYarns scaled = yarns;
  for (dvec3& p : scaled.points) p /= diameter;
  for (PeriodicYarn& y : scaled.yarns) y.length /= diameter;
  scaled.period /= diameter;
  double longest = 0;
  for (const PeriodicYarn& y : scaled.yarns) longest = std::max(longest, y.length / y.count);
  const double hard = barrier_for(settings.closest, 1.01 * longest, settings.contact_samples);
  Descent work(scaled, settings);
  Relaxed out;
  const auto finish = [&] {
    out.strain = work.strain();
    for (size_t i = 0; i < yarns.points.size(); ++i) yarns.points[i] = scaled.points[i] * diameter;
    yarns.period = scaled.period * diameter;
    out.closest = closest_distance(yarns, settings.neighbours * diameter, 1.8 * diameter) / diameter;
    return out;
  };
  const auto settle = [&](double tolerance, int most, bool free_period) {
    work.free_period(free_period);
    for (int step = 0; step < most; ++step) {
      work.look();
      out.force = work.force(), out.period_force = work.period_force();
      if (out.force < tolerance && out.period_force < tolerance) return;
      if (!work.step()) return;
      ++out.steps;
    }
  };
  // The yarn swells under a wide barrier, from kSoft of its diameter on; with its whole diameter the barrier narrows.
  double share = 0, hardness = kSoft;
  work.barrier(0.01, 0.005);
  while (out.steps < settings.max_steps && (share < 1 || hardness < hard)) {
    work.look();
    const double room = work.closest_samples();
    if (share < 1)
      share = std::clamp(0.9 * room / kSoft, share * 1.0, std::min(1.0, share == 0 ? 1.0 : share * 1.25));
    else
      hardness = std::clamp(0.5 * (hardness + room), hardness, hard);
    if (share == 1 && hardness > 0.995 * hard && room > hard) hardness = hard;
    work.barrier(share, share * hardness);
    settle(0.1, 8, share > 0.6 || work.strain() > 0.02);
    out.thickness_share = share;
    if (progress && !progress(share, out.force)) return finish();
  }
  settle(settings.force_tolerance, std::max(0, settings.max_steps - out.steps), true);
  finish();
  out.converged = share >= 1 && hardness >= hard && out.force < settings.force_tolerance &&
                  out.period_force < settings.force_tolerance && out.closest >= settings.closest;
  return out;
}

double closest_distance(const PeriodicYarns& yarns, double neighbours, double reach) {
  const std::vector<YarnSegment> segments = segments_of(yarns);
  double least = reach;
  for (const SegmentPair& pair : near_pairs(yarns, segments, reach, neighbours))
    least = std::min(least, glm::length(closest_of(yarns, segments, pair).way));
  return least;
}

}  // namespace wale
