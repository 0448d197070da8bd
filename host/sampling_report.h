#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "host/tile_error.h"

namespace wale {

/// What a render was asked for and what it reached; a goal of 0 was not set.
struct SamplingReport {
  int spp = 0;  ///< most samples per pixel
  double error = 0, seconds = 0;
  bool stopped = false;  ///< before it was done
  Reached reached;
};

/// "64 samples per pixel", "16 to 768 samples per pixel, 143 on average,".
std::string samples_text(const Reached& reached);

/// What became of the goal, in a line; empty when there was none.
std::string goal_text(const SamplingReport& report);

/// Objects "goal" and "reached" of --stats; null for goals that were not set and errors that nothing is known of.
void add_sampling(nlohmann::ordered_json& stats, const SamplingReport& report);

/// The same as attributes of an EXR: wale:goal.error, wale:goal.seconds, wale:goal.spp, wale:error.worst, .p95,
/// .median, .floor, wale:samples.least, .most, .mean. What is null there is absent.
std::vector<std::pair<std::string, float>> sampling_attributes(const SamplingReport& report);

}  // namespace wale
