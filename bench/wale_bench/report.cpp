#include "bench/wale_bench/report.h"

#include <fmt/format.h>

#include <ctime>
#include <nlohmann/json.hpp>

namespace wale::bench {
namespace {

using Json = nlohmann::ordered_json;

Json or_null(bool verified, double value) { return verified ? Json(value) : Json(nullptr); }

double mega_per_second(const RayRow& row, const std::vector<double>& seconds) {
  const double s = median(seconds);
  return s > 0 ? 1e-6 * double(row.rays) / s : 0;
}

std::string utc_now() {
  char text[32];
  const std::time_t now = std::time(nullptr);
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", std::gmtime(&now));
  return text;
}

Json rays_json(const BenchReport& report, const FabricResult& fabric) {
  Json rows = Json::array();
  for (const RayRow& r : fabric.rays) {
    const double rate = mega_per_second(r, r.device);
    rows.push_back({{"kind", r.name()},
                    {"attenuated", r.attenuated},
                    {"rays", r.rays},
                    {"mrays_per_second", or_null(r.verified(), rate)},
                    {"mrays_per_cpu_second", or_null(r.verified(), report.device.cpu ? mega_per_second(r, r.cpu) : 0)},
                    {"seconds", r.device},
                    {"cpu_seconds", r.cpu},
                    {"nodes_per_ray", r.nodes},
                    {"leaves_per_ray", r.leaves},
                    {"bytes_per_ray", r.bytes},
                    {"bandwidth_share", or_null(r.verified(), 1e6 * rate * r.bytes / report.rates.bytes_per_second)},
                    {"checked", r.agreement.checked},
                    {"agree", r.agreement.agree},
                    {"repeatable", r.repeats},
                    {"verified", r.verified()}});
  }
  return rows;
}

Json fabric_json(const BenchReport& report, const FabricResult& f) {
  Json ratios = Json::object();
  for (const auto& [kind, values] : f.replay_over_render) ratios[kind] = median(values);
  const auto samples = [&](const std::vector<double>& seconds) {
    const double s = median(seconds);
    return s > 0 ? double(f.samples) / s : 0;
  };
  return {{"name", f.name},
          {"segments", f.segments},
          {"patches", f.patches},
          {"nodes", f.nodes},
          {"bytes_per_segment", {{"trace", f.trace_bytes}, {"shade", f.shade_bytes}}},
          {"knit_seconds", f.knit_seconds},
          {"warp_seconds", median(f.warp)},
          {"pack_seconds", median(f.pack)},
          {"tree_seconds", median(f.tree)},
          {"build_cpu_seconds", median(f.build_cpu)},
          {"rays", rays_json(report, f)},
          {"render",
           {{"samples", f.samples},
            {"samples_per_second", samples(f.render_wall)},
            {"samples_per_cpu_second", samples(f.render_cpu)},
            {"ns_per_path_vertex", f.ns_per_vertex},
            {"replay_over_render", ratios}}},
          {"stages", profile_json(f.stages)}};
}

}  // namespace

bool BenchReport::verified() const { return failure().empty(); }

std::string BenchReport::failure() const {
  for (const FabricResult& f : fabrics)
    for (const RayRow& r : f.rays) {
      const char* kind = r.attenuated ? "attenuated " : "";
      if (!r.repeats) return fmt::format("{}: {}{} rays: not the same hits each time", f.name, kind, r.name());
      if (!r.agreement.passes())
        return fmt::format("{}: {}{} rays: {} of {} differ from the brute-force oracle", f.name, kind, r.name(),
                           r.agreement.checked - r.agreement.agree, r.agreement.checked);
    }
  if (score && !score->picture.same)
    return fmt::format(
        "{}: the picture is not the reference's: a tile is {:.1f} standard errors off, mean square {:.2f}", kFrozenName,
        score->picture.largest_z, score->picture.mean_z2);
  return "";
}

Json report_json(const BenchReport& report) {
  const DeviceTraits& d = report.device;
  Json out = {{"schema", kSchema},
              {"date", utc_now()},
              {"device",
               {{"name", d.name},
                {"vendor", d.vendor},
                {"platform", d.platform},
                {"driver", d.driver},
                {"version", d.version},
                {"cpu", d.cpu},
                {"compute_units", d.compute_units},
                {"lanes", d.lanes},
                {"pool", d.pool},
                {"global_bytes", d.global_bytes},
                {"kernel_options", d.build_options}}},
              {"rates",
               {{"bytes_per_second", report.rates.bytes_per_second},
                {"operations_per_second", report.rates.operations_per_second},
                {"copied_bytes", report.rates.copied_bytes}}},
              {"repeats", report.repeats},
              {"verified", report.verified()},
              {"score", nullptr},
              {"fabrics", Json::array()}};
  if (report.score) {
    const Score& s = *report.score;
    out["score"] = {{"workload", kFrozenName},
                    {"score", or_null(report.verified(), s.score)},
                    {"seconds", d.cpu ? "CPU seconds over compute units" : "device"},
                    {"speeds", s.speeds},
                    {"picture",
                     {{"same", s.picture.same},
                      {"largest_z", s.picture.largest_z},
                      {"mean_z2", s.picture.mean_z2},
                      {"rmse_share", s.picture.rmse_share}}}};
  }
  for (const FabricResult& f : report.fabrics) out["fabrics"].push_back(fabric_json(report, f));
  return out;
}

std::string report_csv(const BenchReport& report) {
  std::string out =
      "schema,device,driver,fabric,segments,kind,attenuated,rays,mrays_per_second,mrays_per_cpu_second,nodes_per_ray,"
      "leaves_per_ray,bytes_per_ray,bytes_per_segment,tree_seconds,verified\n";
  const auto quoted = [](std::string text) {
    for (size_t at = 0; (at = text.find('"', at)) != std::string::npos; at += 2) text.insert(at, 1, '"');
    return '"' + text + '"';
  };
  for (const FabricResult& f : report.fabrics)
    for (const RayRow& r : f.rays) {
      const bool v = r.verified();
      const auto speed = [&](double value) { return v ? fmt::format("{:.4f}", value) : std::string(); };
      out += fmt::format("{},{},{},{},{},{},{},{},{},{},{:.3f},{:.3f},{:.1f},{:.2f},{:.4f},{}\n", kSchema,
                         quoted(report.device.name), quoted(report.device.driver), quoted(f.name), f.segments, r.name(),
                         r.attenuated ? 1 : 0, r.rays, speed(mega_per_second(r, r.device)),
                         report.device.cpu ? speed(mega_per_second(r, r.cpu)) : "", r.nodes, r.leaves, r.bytes,
                         f.trace_bytes, median(f.tree), v ? 1 : 0);
    }
  return out;
}

std::string report_text(const BenchReport& report) {
  const DeviceTraits& d = report.device;
  std::string out = fmt::format(
      "{}\n{} {}, {} compute units, {} lanes, {} paths in flight{}{}\n"
      "copies {:.1f} GB/s, multiply-adds {:.1f} Gop/s; medians of {}\n",
      d.name, d.platform, d.driver, d.compute_units, d.lanes, d.pool, d.build_options.empty() ? "" : ", options",
      d.build_options, 1e-9 * report.rates.bytes_per_second, 1e-9 * report.rates.operations_per_second, report.repeats);
  for (const FabricResult& f : report.fabrics) {
    out += fmt::format(
        "\n{}: {} segments, {:.1f} bytes a segment to trace, {:.1f} to shade\n"
        "knit {:.3f} s, warp {:.3f} s, pack {:.3f} s, tree {:.3f} s; {:.3f} CPU s for the last three\n"
        "{:<20}{:>10}{:>10}{:>14}{:>8}{:>8}{:>11}{:>10}\n",
        f.name, f.segments, f.trace_bytes, f.shade_bytes, f.knit_seconds, median(f.warp), median(f.pack),
        median(f.tree), median(f.build_cpu), "rays", "number", "Mrays/s", "/CPU second", "nodes", "leaves", "bytes/ray",
        "bandwidth");
    for (const RayRow& r : f.rays) {
      const std::string name = (r.attenuated ? "attenuated " : "") + r.name();
      const double rate = mega_per_second(r, r.device);
      if (r.verified())
        out += fmt::format("{:<20}{:>10}{:>10.3f}{:>14}{:>8.2f}{:>8.2f}{:>11.0f}{:>8.1f} %\n", name, r.rays, rate,
                           d.cpu ? fmt::format("{:.3f}", mega_per_second(r, r.cpu)) : "", r.nodes, r.leaves, r.bytes,
                           1e8 * rate * r.bytes / report.rates.bytes_per_second);
      else
        out += fmt::format("{:<20}{:>10}  not verified\n", name, r.rays);
    }
    const double wall = median(f.render_wall);
    out += fmt::format("whole renders: {:.0f} samples per second, {:.0f} ns a path vertex\n",
                       wall > 0 ? double(f.samples) / wall : 0, f.ns_per_vertex);
    for (const auto& [kind, ratios] : f.replay_over_render)
      out += fmt::format("  {} rays alone, over those inside the render: {:.3f}\n", kind, median(ratios));
    out += fmt::format("{:<16}{:>10}{:>12}{:>12}{:>12}{:>12}\n", "stage", "items", "ns/item", "floor ns", "bytes/item",
                       "ops/item");
    for (const StageProfile& s : f.stages)
      out +=
          fmt::format("{:<16}{:>10}{:>12.1f}{:>12.1f}{:>12.0f}{:>12}\n", s.stage, s.items, s.ns_per_item(), s.floor_ns,
                      s.bytes_per_item, s.operations_per_item > 0 ? fmt::format("{:.0f}", s.operations_per_item) : "");
  }
  if (report.score && report.verified())
    out += fmt::format("\n{}: score {:.1f}; the picture is the reference's, to {:.2f} % with mean z^2 {:.2f}\n",
                       kFrozenName, report.score->score, 100 * report.score->picture.rmse_share,
                       report.score->picture.mean_z2);
  return out;
}

}  // namespace wale::bench
