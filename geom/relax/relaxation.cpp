#include "geom/relax/relaxation.h"

#include <algorithm>
#include <chrono>

#include "geom/relax/descent.h"
#include "geom/relax/resolution.h"
#include "geom/relax/step_bound.h"

namespace wale {
namespace {

using Clock = std::chrono::steady_clock;

// Relaxes yarns of one resolution, in units of their diameter.
class Swelling {
 public:
  Swelling(PeriodicYarns& yarns, const RelaxSettings& settings, Clock::time_point end,
           const std::function<bool(double, double)>& progress, Relaxed& out)
      : settings_(settings), yarns_(yarns), work_(yarns, settings), end_(end), progress_(progress), out_(out) {
    double longest = 0;
    for (const PeriodicYarn& y : yarns.yarns) longest = std::max(longest, y.length / y.count);
    hard_ = barrier_for(settings.closest, 1.01 * longest, settings.contact_samples);
  }

  // The yarn swells under a wide barrier, from kSoft of its diameter on; with its whole diameter the barrier narrows.
  void run(double tolerance) {
    constexpr double kSoft = 0.6, kRough = 0.1;
    // Yarns that hold each other up on their way stretch by some; from that much none was seen to come back.
    constexpr double kHopeless = 3;
    constexpr int kRoughSteps = 8;
    double share = 0, hardness = std::min(kSoft, hard_);
    see();
    work_.barrier(1e-2, 1e-3);
    work_.look();
    // What comes nearly relaxed goes on from there.
    if (const double room = work_.closest_samples(); 0.9 * room > hardness)
      share = 1, hardness = room > hard_ ? hard_ : std::min(0.9 * room, hard_);
    int before = -1;
    while (!over() && (share < 1 || hardness < hard_)) {
      const double last_share = share, last_hardness = hardness;
      work_.look();
      const double room = work_.closest_samples();
      if (share < 1)
        share = std::clamp(0.9 * room / hardness, share, std::min(1.0, share == 0 ? 1.0 : share * 1.25));
      else
        hardness = std::clamp(0.5 * (hardness + room), hardness, hard_);
      if (share == 1 && hardness > 0.995 * hard_ && room > hard_) hardness = hard_;
      // Nothing gives way and nothing moves.
      if (share == last_share && hardness == last_hardness && out_.steps == before) break;
      before = out_.steps;
      work_.barrier(share, share * hardness);
      const bool rests = settle(kRough, kRoughSteps, share > kSoft || work_.strain() > 0.02, share);
      out_.thickness_share = share;
      if (rests && share == 1 && work_.strain() > kHopeless * settings_.most_strain) break;
    }
    const bool whole = share == 1 && hardness == hard_;
    bool rests = false;
    if (whole) {
      out_.thickness_share = 1;
      work_.barrier(1, hard_);
      rests = settle(tolerance, settings_.max_steps, true, share);
    }
    out_.strain = work_.strain();
    out_.energy = work_.energy();
    const bool jammed = !whole || (rests && out_.strain > settings_.most_strain);
    out_.end = stopped_                            ? RelaxEnd::stopped
               : rests && !jammed                  ? RelaxEnd::at_rest
               : late_                             ? RelaxEnd::time
               : out_.steps >= settings_.max_steps ? RelaxEnd::steps
               : jammed                            ? RelaxEnd::jammed
                                                   : RelaxEnd::stuck;
  }

 private:
  bool over() {
    late_ = late_ || Clock::now() > end_;
    return stopped_ || late_ || out_.steps >= settings_.max_steps;
  }

  void tell(double share) {
    if (!stopped_ && progress_ && !progress_(share, out_.force)) stopped_ = true;
  }

  void see() const {
    if (settings_.watch) settings_.watch(settings_.path, yarns_);
  }

  // Whether forces came below the tolerance.
  bool settle(double tolerance, int most, bool free_period, double share) {
    work_.free_period(free_period);
    for (int step = 0; step < most && !over(); ++step) {
      work_.look();
      out_.force = work_.force(), out_.period_force = work_.period_force();
      if (out_.force < tolerance && out_.period_force < tolerance) return true;
      tell(share);
      // One step of a large tile may take minutes.
      if (stopped_ || !work_.step([&] { return tell(share), over(); })) return false;
      ++out_.steps;
      see();
    }
    return false;
  }

  const RelaxSettings& settings_;
  const PeriodicYarns& yarns_;
  Descent work_;
  Clock::time_point end_;
  const std::function<bool(double, double)>& progress_;
  Relaxed& out_;
  double hard_ = 0;
  bool stopped_ = false, late_ = false;
};

}  // namespace

PeriodicYarns in_diameters(PeriodicYarns yarns) {
  const double diameter = 2 * yarns.radius;
  for (dvec3& p : yarns.points) p /= diameter;
  for (PeriodicYarn& y : yarns.yarns) y.length /= diameter;
  yarns.period /= diameter;
  yarns.radius = 0.5;
  return yarns;
}

Clock::time_point end_of(const RelaxSettings& settings) {
  const auto left = std::chrono::duration<double>(std::min(settings.max_seconds, 1e6));
  return std::min(settings.until, Clock::now() + std::chrono::duration_cast<Clock::duration>(left));
}

Relaxed relax(PeriodicYarns& yarns, const RelaxSettings& settings,
              const std::function<bool(double, double)>& progress) {
  constexpr double kCoarseTolerance = 0.03, kCoarseClosest = 0.9;
  const double diameter = 2 * yarns.radius;
  const auto end = end_of(settings);
  PeriodicYarns scaled = in_diameters(yarns);
  Relaxed out;
  if (settings.coarse_first) {
    // Half the points do for the long way; cutting segments in two moves nothing.
    if (auto coarse = coarsened(scaled, settings.neighbours, [&](const PeriodicYarns& state) {
          if (settings.watch) settings.watch(settings.path, state);
          return Clock::now() > end;
        })) {
      RelaxSettings rough = settings;
      rough.contact_samples *= 2;
      rough.closest = kCoarseClosest;
      Swelling(*coarse, rough, end, progress, out).run(std::max(kCoarseTolerance, settings.force_tolerance));
      scaled = refined(*coarse);
    }
  }
  if (out.end != RelaxEnd::stopped) Swelling(scaled, settings, end, progress, out).run(settings.force_tolerance);
  for (size_t i = 0; i < yarns.points.size(); ++i) yarns.points[i] = scaled.points[i] * diameter;
  yarns.period = scaled.period * diameter;
  out.closest = closest_distance(yarns, settings.neighbours * diameter, 1.8 * diameter) / diameter;
  // Segments that stretched lie farther apart than their contact was reckoned for.
  if (out.end == RelaxEnd::at_rest && out.closest < settings.closest) out.end = RelaxEnd::jammed;
  out.converged = out.end == RelaxEnd::at_rest;
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
