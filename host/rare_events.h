#pragma once
#include <cstdint>

#include "shared/wale_types.h"

namespace wale {

/// How a rare event reads in statistics, and what it means for the picture.
struct RareEvent {
  uint32_t counter;  ///< W_EVENT_*
  const char* name;
  enum class Weight { note, warning, bug } weight;  ///< note: in the statistics only; bug: the run fails with status 3
};

inline constexpr RareEvent kRareEvents[] = {
    {W_EVENT_NAN, "nan", RareEvent::Weight::bug},
    {W_EVENT_STACK_FULL, "stack full", RareEvent::Weight::warning},
    {W_EVENT_PATH_CAP, "depth limit", RareEvent::Weight::warning},
    {W_EVENT_ENERGY, "energy above 1", RareEvent::Weight::warning},
    {W_EVENT_RAY, "ray not finite", RareEvent::Weight::warning},
    {W_EVENT_SPHERE, "sphere of a joint or end", RareEvent::Weight::note},
    {W_EVENT_PARALLEL, "ray along an axis", RareEvent::Weight::note},
};

}  // namespace wale
