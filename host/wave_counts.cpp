#include "host/wave_counts.h"

#include <algorithm>

namespace wale {

double WaveCounts::bounce_seconds() const {
  double seconds = -primary_seconds;
  for (const char* kernel : {"intersect", "intersect_packets"})
    if (const auto found = stages.find(kernel); found != stages.end()) seconds += found->second.seconds;
  return seconds;
}

WaveCounts& WaveCounts::operator+=(const WaveCounts& other) {
  primary += other.primary, bounce += other.bounce, shadow += other.shadow, paths += other.paths;
  deepest = std::max(deepest, other.deepest);
  for (size_t i = 0; i < events.size(); ++i) events[i] += other.events[i];
  for (const auto& [name, time] : other.stages) {
    StageTime& stage = stages[name];
    stage.seconds += time.seconds, stage.launches += time.launches, stage.items += time.items;
  }
  primary_seconds += other.primary_seconds;
  for (const auto& [file, seconds] : other.program_seconds) program_seconds[file] += seconds;
  return *this;
}

void WaveCounts::add_bounce(const std::string& nearest, uint32_t live, const uint32_t* hits, uint32_t shadow_rays) {
  stages[nearest].items += live;
  for (const char* kernel : {"compact_count", "compact_scatter"}) stages[kernel].items += live;
  for (const char* kernel : {"compact_count", "compact_scatter"}) stages[kernel].items += live;  // after shading
  stages["shade_ply"].items += hits[0];
  stages["shade_surface"].items += hits[1];
  stages["miss"].items += hits[2];
  stages["shade_fibre"].items += hits[3];
  stages["connect"].items += shadow_rays;
}

void WaveCounts::add_wave(uint32_t wave_paths) {
  for (const char* kernel : {"generate", "compact_count", "compact_scatter", "accumulate", "accumulate_aov"})
    stages[kernel].items += wave_paths;
}

void WaveCounts::add_launch(const std::string& kernel, double launch_seconds, bool camera_rays) {
  StageTime& stage = stages[kernel];
  stage.seconds += launch_seconds;
  ++stage.launches;
  if (camera_rays) primary_seconds += launch_seconds;
}

double device_seconds(const cl::Event& event) {
  return 1e-9 * double(event.getProfilingInfo<CL_PROFILING_COMMAND_END>() -
                       event.getProfilingInfo<CL_PROFILING_COMMAND_START>());
}

}  // namespace wale
