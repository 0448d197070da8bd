#pragma once
#include "geom/chart/stitch_chart.h"

namespace wale {

/// The unit that repeats in the middle of a swatch, across and up: rows in the order of knitting, of which each begins
/// and ends where the row below does. Empty where nothing repeats at least twice. Of its cyclic shifts, the one that
/// begins with most knit stitches.
struct RepeatUnit {
  std::vector<ChartRow> rows;
  size_t first_row = 0;               ///< of the swatch
  int first_wale = 0, last_wale = 0;  ///< of the swatch
};
RepeatUnit repeat_unit(const std::vector<ChartRow>& swatch);

}  // namespace wale
