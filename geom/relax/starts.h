#pragma once
#include <functional>

#include "geom/relax/relaxation.h"

namespace wale {

/// Relaxes yarns from where they are and from `starts` - 1 places that the yarns were shaken to, and keeps the state of
/// least energy (of those that converged, if any did; the first of equals). Not converged if time ended any start. A
/// knit has many states of rest, as its loops buckle to one side or the other; which one relaxation finds hangs on its
/// path. Places are the same every time. Runs on `threads` threads; the result does not depend on their number.
/// Every start is a path of settings.watch. `progress` gets the start's number and what relax() tells, one call at a
/// time; false stops all.
Relaxed relax_from_starts(PeriodicYarns& yarns, const RelaxSettings& settings, int starts, unsigned threads,
                          const std::function<bool(int start, double share, double force)>& progress = {});

/// Moves yarns at random, by about `amplitude` diameters and evenly over some diameters along them, and the period with
/// them; no yarn passes through another. The same for the same `seed` everywhere.
void shake(PeriodicYarns& yarns, double amplitude, double neighbours, uint64_t seed);

}  // namespace wale
