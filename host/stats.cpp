#include "host/stats.h"

#include <sys/resource.h>

#include <nlohmann/json.hpp>

#include "host/atomic_file.h"

namespace wale {

uint64_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return uint64_t(usage.ru_maxrss) * 1024;  // Linux counts kilobytes
}

std::string Stats::json() const {
  using nlohmann::ordered_json;
  ordered_json out;
  out["scene"] = scene;
  out["device"] = {{"name", device}, {"driver", driver}, {"platform", platform}, {"kernel_options", kernel_options}};
  out["devices"] = ordered_json::array();
  for (const auto& d : devices)
    out["devices"].push_back({{"number", d.number},
                              {"name", d.name},
                              {"driver", d.driver},
                              {"samples", d.samples},
                              {"share", samples ? double(d.samples) / double(samples) : 0},
                              {"rays", d.rays},
                              {"busy_seconds", d.busy_seconds},
                              {"blocks_taken_over", d.moved_blocks}});
  out["features"] = features;
  out["programs"] = ordered_json::array();
  for (const auto& p : programs)
    out["programs"].push_back({{"name", p.name}, {"build_seconds", p.build_seconds}, {"cached", p.cached}});
  out["geometry"] = ordered_json::object();
  for (const auto& [name, g] : geometry) out["geometry"][name] = {{"count", g.count}, {"bytes", g.bytes}};
  out["stage_seconds"] = ordered_json(stage_seconds);
  out["stages"] = profile_json(stages);
  out["ns_per_path_vertex"] = ns_per_vertex;
  out["device_rates"] = {{"bytes_per_second", rates.bytes_per_second},
                         {"operations_per_second", rates.operations_per_second}};
  out["rays"] = ordered_json::object();
  Rays all;
  const auto rays_json = [](const Rays& r) {
    ordered_json j = {{"count", r.count}, {"seconds", r.seconds}, {"mrays_per_second", nullptr}};
    if (r.seconds > 0) j["mrays_per_second"] = double(r.count) / r.seconds * 1e-6;
    return j;
  };
  for (const auto& [kind, r] : rays) {
    out["rays"][kind] = rays_json(r);
    all.count += r.count;
    all.seconds += r.seconds;
  }
  out["rays"]["all"] = rays_json(all);
  out["image"] = {{"width", width}, {"height", height}, {"samples_per_pixel", samples_per_pixel}};
  out["samples"] = samples;
  add_sampling(out, sampling);
  out["rare_events"] = ordered_json(rare_events);
  out["total_seconds"] = total_seconds;
  out["first_sample_seconds"] = first_sample_seconds;
  out["start"] = ordered_json::object();
  for (const auto& [step, seconds] : start) out["start"][step] = seconds;
  out["peak_memory_bytes"] = peak_memory_bytes();
  // A driver may hand back a name that is not UTF-8; it must not cost the statistics.
  return out.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

void write_stats(const Stats& stats, const std::filesystem::path& file) { write_text_file(file, stats.json()); }

}  // namespace wale
