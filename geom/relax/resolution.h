#pragma once
#include <functional>
#include <optional>

#include "geom/relax/periodic_yarns.h"

namespace wale {

/// The same yarns with every segment cut in two.
PeriodicYarns refined(const PeriodicYarns& yarns);

/// Yarns with every second point left out, in units in which the yarn is 1 thick. These points go to the middles
/// between their neighbours in steps that let no yarn pass another (step_bound.h); nothing where that is barred or
/// would halve the least distance, where a yarn has an odd number of points, or where `over`, which sees every state on
/// the way, ended it.
std::optional<PeriodicYarns> coarsened(const PeriodicYarns& yarns, double neighbours,
                                       const std::function<bool(const PeriodicYarns&)>& over = {});

}  // namespace wale
