#pragma once
#include <vector>

#include "geom/cycle_samples.h"

namespace wale {

/// Which stitch the samples of a tile belong to. A stitch is numbered (column, row); tile instance (i, j) holds columns
/// i*stitches.x .. and rows j*stitches.y .., and a course yarn's loop is one stitch from the bottom of one sinker to
/// the next, head included: the head lies in the next row's cell but is the loop's own.
struct StitchPlaces {
  std::vector<std::vector<ivec2>> of_curve;  ///< [curve][sample], relative to the link's own tile instance
  dvec2 phase{0.5, 0.5};                     ///< middle of stitch (c, r) at (c, r) + phase, in stitches
  dvec2 size{1, 1};                          ///< of a stitch, metres in the cloth
  ivec2 per_tile{1, 1};
};

/// Rows come from the mean height of each course yarn; columns from its loops where it has as many heads as the pattern
/// says, else from equal shares of its length. Yarns that do not follow a course are divided by place.
StitchPlaces stitch_places(const Pattern& pattern, const PartnerMap& partners, const TileSamples& tile, dvec3 scale);

}  // namespace wale
