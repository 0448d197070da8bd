#pragma once
#include "geom/relax/local_term.h"
#include "geom/relax/periodic_yarns.h"

namespace wale {

/// Way from the segment's first point to its second one.
dvec3 edge_of(const PeriodicYarns& yarns, const YarnSegment& segment);

/// K/2 l0 (|v|/l0 - 1)^2 of a segment v of rest length l0.
LocalTerm stretch_term(const PeriodicYarns& yarns, const YarnSegment& segment, double stiffness, Order order);

/// 1/l0 (1 - t1.t2) of two segments that follow one another, directions t: for small angles the energy
/// 1/2 l0 curvature^2 of a rod with bending stiffness 1.
LocalTerm bending_term(const PeriodicYarns& yarns, const YarnSegment& first, const YarnSegment& second, Order order);

}  // namespace wale
