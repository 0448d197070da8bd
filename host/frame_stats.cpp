#include "host/frame_stats.h"

#include <unistd.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "host/atomic_file.h"

namespace wale {

uint64_t resident_memory_bytes() {
  std::ifstream in("/proc/self/statm");
  uint64_t all = 0, resident = 0;
  in >> all >> resident;
  return resident * uint64_t(sysconf(_SC_PAGESIZE));
}

void FrameStats::Row::add(const Redone& redone, const FabricDevice& fabrics, double seconds) {
  knitted += redone.knitted;
  uploaded += redone.fabrics;
  moved += redone.moved;
  update_seconds += seconds;
  host_seconds += redone.host_seconds;
  if (!redone.moved) return;
  warp_seconds += fabrics.move_seconds;
  refit_seconds += fabrics.refit_seconds;
}

void FrameStats::Row::add(const Rendered& r) {
  trace_seconds = r.seconds;
  first_ray_seconds = r.program_seconds + r.first_sample_seconds;
  samples_per_pixel = r.reached.mean;
  rays = r.counts.primary + r.counts.bounce + r.counts.shadow;
  resident_bytes = resident_memory_bytes();
}

void FrameStats::write(const std::filesystem::path& file) const {
  using nlohmann::ordered_json;
  ordered_json out = {{"frames", ordered_json::array()}};
  for (const Row& row : rows)
    out["frames"].push_back({{"frame", row.frame},
                             {"knitted", row.knitted},
                             {"uploaded", row.uploaded},
                             {"moved", row.moved},
                             {"update_seconds", row.update_seconds},
                             {"host_seconds", row.host_seconds},
                             {"warp_seconds", row.warp_seconds},
                             {"refit_seconds", row.refit_seconds},
                             {"first_ray_seconds", row.first_ray_seconds},
                             {"trace_seconds", row.trace_seconds},
                             {"write_seconds", row.write_seconds},
                             {"samples_per_pixel", row.samples_per_pixel},
                             {"rays", row.rays},
                             {"resident_bytes", row.resident_bytes}});
  write_text_file(file, out.dump(2) + "\n");
}

}  // namespace wale
