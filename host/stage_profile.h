#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "host/device_rates.h"
#include "host/features.h"
#include "host/wave_counts.h"

namespace wale {

/// What one stage of a render took, beside the least that the device could take for what it moves and computes.
struct StageProfile {
  std::string stage;  ///< name of its file
  double seconds = 0;
  uint64_t launches = 0, items = 0;
  double bytes_per_item = 0, operations_per_item = 0;  ///< see host/stages.cpp; operations 0: not counted
  double floor_ns = 0;                                 ///< per item: the larger of bytes and operations at best

  double ns_per_item() const { return items ? 1e9 * seconds / double(items) : 0; }
};

/// What a traversal moves and computes for a ray, from counted visits; 0: not counted.
struct TraversalCost {
  double bytes = 0, operations = 0;
};

/// The stages that ran, in the order of a bounce.
std::vector<StageProfile> profile_stages(const Features& features, const WaveCounts& counts, const DeviceRates& rates,
                                         const TraversalCost& path = {}, const TraversalCost& shadow = {});

/// Nanoseconds of all stages per vertex of a path: per nearest-hit ray.
double ns_per_vertex(const WaveCounts& counts);

nlohmann::ordered_json profile_json(const std::vector<StageProfile>& stages);

}  // namespace wale
