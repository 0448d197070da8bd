#pragma once
#include <functional>

#include "geom/chart/knit_tile.h"

namespace wale {

/// Relaxes the tile of one loop length, in yarn diameters: knit_once() of a chart.
using KnitOfLength =
    std::function<KnittedTile(double diameters, const KnitSettings&, const std::function<bool(double)>& progress)>;

/// Looks for the loop length that gives the gauge of the settings, relaxing tile after tile. From one start each, as
/// the search is for the loop's length.
KnittedTile knit_to_gauge(const KnitSettings& settings, const KnitOfLength& knit,
                          const std::function<bool(double)>& progress);

}  // namespace wale
