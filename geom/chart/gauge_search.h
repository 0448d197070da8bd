#pragma once
#include <functional>

#include "geom/chart/knit_tile.h"
#include "geom/chart/loops.h"

namespace wale {

/// Looks for the loop length that gives the gauge of the settings, relaxing tile after tile. From one start each, as
/// the search is for the loop's length.
KnittedTile knit_to_gauge(const StitchChart& chart, const Knit& knit, const KnitSettings& settings,
                          const std::function<bool(double)>& progress);

}  // namespace wale
