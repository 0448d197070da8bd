#pragma once
#include <functional>
#include <optional>

#include "geom/chart/stitch_chart.h"
#include "geom/pattern.h"
#include "geom/relax/relaxation.h"

namespace wale {

/// Starts that find states of nearly the least energy in tiles of a few stitches (bench/results/relaxation.md).
constexpr int kStarts = 4;

/// Strains along course and wale at which a tile is relaxed for its table.
constexpr double kStrains[] = {-0.2, 0, 0.25, 0.5, 1};

/// How a chart is knitted. Lengths in metres.
struct KnitSettings {
  double yarn_thickness = 1e-3;  ///< diameter
  double loop_length = 0;        ///< yarn in one stitch; 0: kPlainLoop yarn diameters
  double step = 0.6;  ///< length of a segment, in yarn diameters; half of it in the last pass, and in the tile
  int max_steps = RelaxSettings().max_steps;         ///< of one start and of the last pass after it
  double max_seconds = RelaxSettings().max_seconds;  ///< of all relaxations together
  int starts = kStarts;                              ///< places to relax from: the state of least energy is kept
  unsigned threads = 0;                  ///< 0: as many as the machine has; the tile does not depend on them
  dvec2 tension{0, 0};                   ///< along the course and the wale: RelaxSettings::tension
  bool strains = false;                  ///< relaxed at kStrains too: Pattern::strains
  double blocking = 0;                   ///< pull on every row and on every wale, beside the tension, B / D^2
  std::optional<dvec2> period;           ///< of the tile, held; else it is free
  std::optional<double> wales, courses;  ///< gauge to reach by the loop length, per metre; at most one of them
  /// RelaxSettings::watch. Paths are the starts, then the finer pass, then the shapes of the table of strains.
  std::function<void(size_t path, const PeriodicYarns&)> watch;
};

/// Loop length of a fabric of medium firmness, in yarn diameters.
constexpr double kPlainLoop = 13.2;
/// Loop lengths, in yarn diameters: shorter ones jam, longer ones are no cloth.
constexpr double kShortestLoop = 6, kLongestLoop = 100;
/// By how much a gauge may be missed, relative.
constexpr double kGaugeTolerance = 0.005;

/// Why a search for a gauge ended.
enum class GaugeEnd {
  reached,  ///< or none was asked for
  none,     ///< no loop length gives it: shorter ones jam, or it lies beyond those that are valid
  tries,    ///< none of those that were tried gives it
  time,     ///< `max_seconds`
  steps,    ///< some loop lengths were not relaxed in `max_steps`, and the others do not give it
  stuck,    ///< of some loop lengths no step led further down, and the others do not give it
};

/// A chart that was knitted, and what was reached.
struct KnittedTile {
  Pattern pattern;
  Relaxed relaxed;
  double loop_length = 0;              ///< metres
  double force_wanted = 0;             ///< where Relaxed::force and period_force end
  dvec2 gauge{0, 0};                   ///< wales and courses per metre
  PeriodicYarns yarns;                 ///< as relaxed: the pattern's are centred and rounded
  std::optional<dvec2> strain_missed;  ///< the first strain at which the tile could not be relaxed
  int tries = 1;                       ///< loop lengths that were tried for the gauge
  GaugeEnd gauge_end = GaugeEnd::reached;
  bool stopped = false;
};

/// Relaxes the chart's yarns into a tile. The tile holds points to the nanometre, colours, chart and settings. Where
/// the relaxation fails or `progress` (share done in [0,1]; false stops) ends it, `relaxed.converged` is false and the
/// pattern is what was reached. Where a gauge is not reached, `gauge_end` says why, and the tile is the nearest.
/// Throws a user error on settings that are not positive, not finite or out of all proportion.
KnittedTile knit_tile(const StitchChart& chart, const KnitSettings& settings,
                      const std::function<bool(double)>& progress = {});

}  // namespace wale
