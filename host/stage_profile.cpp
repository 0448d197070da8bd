#include "host/stage_profile.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "host/stages.h"

namespace wale {

std::vector<StageProfile> profile_stages(const Features& features, const WaveCounts& counts, const DeviceRates& rates,
                                         const TraversalCost& path, const TraversalCost& shadow) {
  std::vector<StageProfile> profiles;
  for (const Stage& stage : wavefront_stages(features)) {
    StageProfile p;
    p.stage = std::filesystem::path(stage.file).stem().string();
    for (const std::string& kernel : stage.kernels) {
      const auto found = counts.stages.find(kernel);
      if (found == counts.stages.end()) continue;
      p.seconds += found->second.seconds;
      p.launches += found->second.launches;
      p.items = std::max(p.items, found->second.items);  // kernels of one stage share their items
    }
    if (p.launches == 0) continue;
    const TraversalCost none, &traversal = p.stage.starts_with("intersect") ? path
                                           : p.stage == "connect"           ? shadow
                                                                            : none;
    p.bytes_per_item = stage.bytes_per_item + traversal.bytes;
    p.operations_per_item = stage.operations_per_item + traversal.operations;
    if (rates.bytes_per_second > 0 && rates.operations_per_second > 0)
      p.floor_ns = 1e9 * std::max(p.bytes_per_item / rates.bytes_per_second,
                                  p.operations_per_item / rates.operations_per_second);
    profiles.push_back(p);
  }
  return profiles;
}

double ns_per_vertex(const WaveCounts& counts) {
  double seconds = 0;
  for (const auto& [name, stage] : counts.stages) seconds += stage.seconds;
  const uint64_t vertices = counts.primary + counts.bounce;
  return vertices ? 1e9 * seconds / double(vertices) : 0;
}

nlohmann::ordered_json profile_json(const std::vector<StageProfile>& stages) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const StageProfile& s : stages)
    out.push_back({{"stage", s.stage},
                   {"seconds", s.seconds},
                   {"launches", s.launches},
                   {"items", s.items},
                   {"ns_per_item", s.ns_per_item()},
                   {"bytes_per_item", s.bytes_per_item},
                   {"operations_per_item", s.operations_per_item},
                   {"floor_ns", s.floor_ns}});
  return out;
}

}  // namespace wale
