#pragma once
#include <vector>

#include "geom/relax/newton_system.h"
#include "geom/relax/periodic_yarns.h"

namespace wale {

/// Closest points of a pair of segments.
Closest closest_of(const PeriodicYarns& yarns, const std::vector<YarnSegment>& segments, const SegmentPair& pair);

/// Moves by `share` of a step: x -> diag(1 + share e, 1) x + share u, and the period.
PeriodicYarns moved(const PeriodicYarns& yarns, const TileStep& step, double share);

/// Largest share, at most 1, of a step on which no two segments can meet, for the derivation see step_bound.cpp.
/// `near` holds all pairs nearer than `reach` that are no neighbours (near_pairs); pairs that it does not hold stay
/// `keep` < reach apart.
double safe_share(const PeriodicYarns& yarns, const std::vector<YarnSegment>& segments,
                  const std::vector<SegmentPair>& near, double reach, double keep, const TileStep& step);

}  // namespace wale
