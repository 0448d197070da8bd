#pragma once
#include <chrono>
#include <cmath>
#include <functional>
#include <string>

#include "geom/relax/periodic_yarns.h"

namespace wale {

/// How yarns are relaxed. Lengths are in yarn diameters D, forces in B / D^2 with the yarn's bending stiffness B: an
/// unstretched, frictionless yarn takes the same shape whatever B is.
struct RelaxSettings {
  double stretch_stiffness = 3000;  ///< B / D^2 per unit of strain
  double closest = 0.95;            ///< least distance of centrelines, D; contact forces reach up to 1 D
  double contact_stiffness = 2000;  ///< B / D^5: energy of a place is this times its two lengths
  int contact_samples = 4;          ///< of a segment, for the integral of contact along it
  double neighbours = 2;            ///< D of arc below which points of one yarn do not touch
  dvec2 tension{0, 0};              ///< force on the whole sides of the tile, along x and along y, B / D^2
  bool free_period_x = true, free_period_y = true;
  double force_tolerance = 2e-3;  ///< largest force on a point and on the period's sides, B / D^2
  double most_strain = INFINITY;  ///< of the yarn: one that had to stretch by more is jammed
  bool coarse_first = true;       ///< with every second point first, where that is safe
  int max_steps = 3000;
  double max_seconds = 600;
  std::chrono::steady_clock::time_point until = std::chrono::steady_clock::time_point::max();  ///< ends it too
  /// Sees every state on a path, in yarn diameters: points go straight from one to the next. Where their number doubles
  /// or halves, points came or went in the middles of segments. Paths may run at the same time.
  std::function<void(size_t path, const PeriodicYarns&)> watch;
  size_t path = 0;  ///< what watch() is told; of several starts or shapes, that of the first
};

/// The same yarns, of which the diameter is 1.
PeriodicYarns in_diameters(PeriodicYarns yarns);

/// When a relaxation that begins now ends.
std::chrono::steady_clock::time_point end_of(const RelaxSettings& settings);

/// Why a relaxation ended.
enum class RelaxEnd {
  at_rest,  ///< forces, contact and strain are as asked for
  time,     ///< max_seconds or `until`
  steps,    ///< max_steps
  jammed,   ///< the yarn did not come to its diameter, or only stretched
  stuck,    ///< no step led further down
  stopped,  ///< `progress` said so
};

/// What was reached.
struct Relaxed {
  bool converged = false;  ///< end is at_rest
  RelaxEnd end = RelaxEnd::stuck;
  int steps = 0;
  double force = 0;            ///< largest left on a point, B / D^2
  double period_force = 0;     ///< and on the period
  double closest = 0;          ///< of centrelines that are no neighbours, D
  double strain = 0;           ///< largest of a segment
  double energy = 0;           ///< less the work of the tension, B / D
  double thickness_share = 0;  ///< of the yarn's diameter that the relaxation came to; 1 unless it failed
};

/// Moves the points and the period to a state of least energy: bending of a yarn that hardly stretches and slides
/// without friction, and contact. Yarns start thin and swell until they have their diameter. No yarn passes through
/// another (step_bound.cpp). Stops on forces, on max_steps or max_seconds, or where no step leads further down.
/// Deterministic, but for what max_seconds cuts off. `progress` gets the share of the diameter that the yarns have and
/// the force left, on every step, and returns false to stop.
Relaxed relax(PeriodicYarns& yarns, const RelaxSettings& settings,
              const std::function<bool(double share, double force)>& progress = {});

/// Least distance between centrelines that are no neighbours, metres; `reach` where all are farther apart than that.
double closest_distance(const PeriodicYarns& yarns, double neighbours, double reach);

}  // namespace wale
