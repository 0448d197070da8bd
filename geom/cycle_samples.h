#pragma once
#include <vector>

#include "geom/flat_knit.h"

namespace wale {

/// Samples of one link of a tile yarn, in the cloth and relative to the link's own tile instance: from its first point
/// up to, not including, its last one, which is the first of the next link.
struct LinkSamples {
  int cycle = 0, order = 0;             ///< tile yarn and place in it
  std::vector<dvec3> centre;            ///< metres
  std::vector<dvec3> normal, binormal;  ///< frame of the yarn axis in pass 0 of the cycle; binormal = tangent x normal
  std::vector<double> arc;              ///< metres from the start of the cycle
  std::vector<dvec3> strained;          ///< where YarnSpec::strains: [i * shapes + shape] offset of the centre, metres
};

/// All that the tile's yarns need once: the same samples are then laid along every full yarn. The least-rotation frame
/// of a periodic curve repeats itself up to one angle per cycle, so pass k of a cycle uses the same frames turned by
/// k * `turn`: nothing is transported along the full yarn and nothing drifts.
struct CycleSamples {
  double length = 0;  ///< metres of one pass
  double turn = 0;    ///< radians by which the frame has turned about the tangent after one pass
  int links = 0;
  long samples = 0;
};

struct TileSamples {
  std::vector<CycleSamples> cycles;
  std::vector<LinkSamples> of_curve;  ///< per curve of the tile
};

/// Chooses the spacing of each tile yarn so that every ply polyline, at any phase, stays within spec.tolerance *
/// spec.ply_radius of its curve. `wrap`: as in InstanceRect; yarns that close may change their twist by half a turn in
/// doing so, which is allowed for. Throws a user error if the tolerance asks for too many samples.
TileSamples sample_tile(const Pattern& pattern, const PartnerMap& partners, const YarnSpec& spec, dvec3 scale,
                        ivec2 wrap = {0, 0});

}  // namespace wale
