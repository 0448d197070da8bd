#pragma once
#include <functional>
#include <optional>

#include "geom/chart/knit_tile.h"

namespace wale {

/// Where the yarn jams in the period that the settings hold: on the straight way to it from the free period, the
/// nearest one that was found to hold, to 1/64 of the way; metres, with four digits in millimetres. What is returned
/// was relaxed with all of the settings but the table of strains. Nothing where the free tile does not relax either, or where the time of the
/// settings, which is that of the search, ends first. `progress`: share done in [0,1]; false stops.
std::optional<dvec2> nearest_period(const StitchChart& chart, const KnitSettings& settings,
                                    const std::function<bool(double)>& progress = {});

}  // namespace wale
