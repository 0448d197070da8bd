#include "host/sampling_report.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace wale {
namespace {

std::string count_text(double samples) {
  return samples < 99.95 && samples != std::floor(samples) ? fmt::format("{:.1f}", samples)
                                                           : fmt::format("{:.0f}", samples);
}

std::string error_text(double error) { return std::isfinite(error) ? fmt::format("{:.2g}", error) : "unknown"; }

}  // namespace

std::string samples_text(const Reached& r) {
  if (r.least == r.most) return fmt::format("{} samples per pixel", r.most);
  return fmt::format("{} to {} samples per pixel, {} on average,", r.least, r.most, count_text(r.mean));
}

std::string goal_text(const SamplingReport& report) {
  const Reached& r = report.reached;
  if (report.error <= 0 && report.seconds <= 0) return "";
  std::string text =
      fmt::format("error of a tile: {} at most, {} in the median", error_text(r.worst), error_text(r.median));
  if (report.error <= 0) return text;
  text += fmt::format("; {:g} was asked for", report.error);
  if (r.missed == 0) return text;
  return text +
         fmt::format(" and missed in {} of {} tiles {}", r.missed, r.tiles,
                     report.stopped ? "when it was stopped" : fmt::format("at the limit of {} samples", report.spp));
}

void add_sampling(nlohmann::ordered_json& stats, const SamplingReport& report) {
  const Reached& r = report.reached;
  const auto known = [](double value, bool is = true) {
    return is && std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
  };
  stats["goal"] = {{"error", known(report.error, report.error > 0)},
                   {"seconds", known(report.seconds, report.seconds > 0)},
                   {"samples_per_pixel", report.spp}};
  stats["reached"] = {
      {"stopped", report.stopped},
      {"tile_error",
       {{"worst", known(r.worst)}, {"p95", known(r.p95)}, {"median", known(r.median)}, {"floor_luminance", r.floor}}},
      {"tiles", r.tiles},
      {"tiles_missed", r.missed},
      {"samples_per_pixel", {{"least", r.least}, {"most", r.most}, {"mean", r.mean}}}};
}

std::vector<std::pair<std::string, float>> sampling_attributes(const SamplingReport& report) {
  const Reached& r = report.reached;
  std::vector<std::pair<std::string, float>> attributes;
  const auto add = [&](const char* name, double value) {
    if (std::isfinite(value)) attributes.emplace_back(name, float(value));
  };
  if (report.error > 0) add("wale:goal.error", report.error);
  if (report.seconds > 0) add("wale:goal.seconds", report.seconds);
  add("wale:goal.spp", report.spp);
  add("wale:error.worst", r.worst);
  add("wale:error.p95", r.p95);
  add("wale:error.median", r.median);
  add("wale:error.floor", r.floor);
  add("wale:samples.least", r.least);
  add("wale:samples.most", r.most);
  add("wale:samples.mean", r.mean);
  return attributes;
}

}  // namespace wale
