#pragma once
#include "geom/relax/local_term.h"
#include "geom/relax/periodic_yarns.h"

namespace wale {

/// Contact of yarns: a potential between all points of two segments, integrated over both,
///
///   integral integral b(d) ds dt,  b(d) = -k (d - a)^2 ln((d - c) / (a - c)) for c < d < a, 0 beyond a,
///
/// the barrier of Li et al. 2020 (Incremental Potential Contact) from c on instead of 0, and integrated along curves as
/// Kaldor et al. 2008 do it: a sum over pairs of segments by their closest points counts a place twice where it passes
/// from one segment to the next, and yarns would catch there instead of sliding.
struct ContactBarrier {
  double from = 1;     ///< a, yarn diameters
  double closest = 0;  ///< c
  double stiffness = 1;
  int samples = 4;  ///< of a segment, evenly along the closed curve, its corners among them
};

/// Infinite energy where samples are at c or nearer.
LocalTerm contact_term(const PeriodicYarns& yarns, const YarnSegment& first, const YarnSegment& second, ivec2 image,
                       const ContactBarrier& barrier, Order order);

/// Least distance between the samples of two segments.
double sample_distance(const PeriodicYarns& yarns, const YarnSegment& first, const YarnSegment& second, ivec2 image,
                       int samples);

/// Least distance of samples that keeps two curves of segments of at most `longest` at `closest` or more.
double barrier_for(double closest, double longest, int samples);

}  // namespace wale
