#pragma once
#include <chrono>
#include <functional>

#include "geom/chart/knit_tile.h"
#include "geom/chart/loops.h"

namespace wale {

/// Relaxes a chart of one loop length, in yarn diameters, from all starts and then with the finer segments: what
/// knit_tile() does but for the search for a gauge and the table of strains. Settings are valid ones.
KnittedTile knit_once(const StitchChart& chart, const Knit& knit, const KnitSettings& settings, double diameters,
                      const std::function<bool(double)>& progress);

/// What the shapes of the table of strains are relaxed with, until the settings' time for all relaxations is over.
RelaxSettings strain_settings(const KnitSettings& settings, std::chrono::steady_clock::time_point until);

/// Yarn of one stitch that the settings ask for, in yarn diameters.
double loop_diameters_of(const KnitSettings& settings);

/// Threads to relax on: those asked for, or as many as the machine has.
unsigned threads_of(const KnitSettings& settings);

/// To the nanometre, as tiles are written; metres.
dvec3 rounded_to_nanometres(const dvec3& p);

}  // namespace wale
