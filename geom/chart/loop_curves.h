#pragma once
#include "geom/chart/loops.h"
#include "geom/relax/periodic_yarns.h"

namespace wale {

/// Sizes of a knit before it is relaxed.
struct LoopSizes {
  double yarn_radius = 0.5e-3;  ///< metres
  double loop_length = 13;      ///< yarn in one stitch, in yarn diameters
  double step = 0.45;           ///< length of a segment, in yarn diameters
};

/// Yarns that pass each other as the loops say, wide and without regard to thickness: where relaxation starts.
PeriodicYarns loop_curves(const Knit& knit, const LoopSizes& sizes);

}  // namespace wale
