#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <ctime>
#include <nlohmann/json.hpp>

#include "geom/chart/held_period.h"
#include "geom/chart/knit_tile.h"
#include "geom/error.h"
#include "host/atomic_file.h"
#include "host/commands.h"
#include "host/progress.h"
#include "host/stop.h"

namespace wale {
namespace {

constexpr double kPerMetre = 1e3, kTenCentimetres = 0.1;

// std::sscanf would read 0x0 as a hexadecimal number.
dvec2 period_of(const std::string& text) {
  dvec2 mm(0);
  const char* const end = text.data() + text.size();
  const auto width = std::from_chars(text.data(), end, mm.x);
  if (width.ec == std::errc() && width.ptr != end && *width.ptr == 'x') {
    const auto height = std::from_chars(width.ptr + 1, end, mm.y);
    if (height.ec == std::errc() && height.ptr == end) return mm / kPerMetre;
  }
  user_error("--period {}: expected WIDTHxHEIGHT in millimetres, for example 8.4x5.2", one_line(text));
}

std::string reached_text(const KnittedTile& tile) {
  const Relaxed& r = tile.relaxed;
  return fmt::format(
      "after {} steps the yarn has {:.0f} % of its thickness, the largest force is {:.3g} and that on the period "
      "{:.3g} "
      "(wanted {:g}), the closest distance {:.3f} yarn diameters",
      r.steps, 100 * r.thickness_share, r.force, r.period_force, tile.force_wanted, r.closest);
}

// Why it ended, and the nearest thing to try. `nearest`: period that holds, where the one asked for jams.
std::pair<std::string, std::string> reason(const KnitSettings& settings, const KnittedTile& tile,
                                           const std::optional<dvec2>& nearest) {
  const bool searches = settings.wales || settings.courses;  // from one start, whatever --starts
  // A search that time ended may hold a tile that ended otherwise.
  switch (tile.gauge_end == GaugeEnd::time ? RelaxEnd::time : tile.relaxed.end) {
    case RelaxEnd::time:
      return {fmt::format("the {:g} s of --seconds are over", settings.max_seconds),
              settings.starts > 1 && !searches ? "more --seconds or fewer --starts may do" : "more --seconds may do"};
    case RelaxEnd::steps:
      return {fmt::format("the {} --steps are done", settings.max_steps), "more of them may do"};
    case RelaxEnd::jammed:
      return {fmt::format("the yarn jams (stretched by {:.1f} %)", 100 * tile.relaxed.strain),
              tile.strain_missed ? "leave --strains out"
              : nearest ? fmt::format("the nearest that holds{}, on the way to the free one, is --period {:.4g}x{:.4g}",
                                      settings.strains ? " without --strains" : "", kPerMetre * nearest->x,
                                      kPerMetre * nearest->y)
              : settings.period  ? "another --period or another --loop may do"
              : settings.wales   ? "fewer --wales may do"
              : settings.courses ? "fewer --courses may do"
                                 : "a longer --loop may do"};
    default:
      return {"no step leads on", "a finer --step may do"};
  }
}

// Why no loop length was found that gives the gauge, up to the nearest one.
std::string gauge_reason(const KnitSettings& settings, const KnittedTile& tile) {
  switch (tile.gauge_end) {
    case GaugeEnd::time:
      return fmt::format(
          "the {:g} s of --seconds are over before a loop length gives this gauge, nothing is written; more of them "
          "may "
          "do; the nearest so far",
          settings.max_seconds);
    case GaugeEnd::steps:
      return fmt::format(
          "no loop length that was relaxed in {} --steps gives this gauge, nothing is written; more of them may do; "
          "the "
          "nearest",
          settings.max_steps);
    case GaugeEnd::stuck:
      return "no loop length that could be relaxed gives this gauge, nothing is written; a finer --step may do; the "
             "nearest";
    case GaugeEnd::tries:
      return fmt::format("none of {} loop lengths gives this gauge, nothing is written; the nearest", tile.tries);
    default:
      return "no loop length gives this gauge, nothing is written; the nearest";
  }
}

// Of the time that is left, as long as the tile itself took a few times over: it is only for the message.
std::optional<dvec2> period_that_holds(const StitchChart& chart, KnitSettings settings, const KnittedTile& tile,
                                       double seconds, bool quiet) {
  if (!settings.period || tile.relaxed.end != RelaxEnd::jammed || tile.stopped || tile.strain_missed) return {};
  settings.max_seconds = std::min(settings.max_seconds - seconds, 5 + 5 * seconds);
  if (settings.max_seconds <= 0) return {};
  Progress bar("nearest period", quiet);
  const auto found = nearest_period(chart, settings, [&](double share) {
    bar.update(share);
    return !stop_requested();
  });
  if (found) bar.finish();
  return found;
}

void refuse_if_not_reached(const KnitArgs& args, const KnitSettings& settings, const KnittedTile& tile,
                           const std::optional<dvec2>& nearest) {
  const std::string chart = args.chart.string();
  if (tile.stopped) user_error("{}: stopped, nothing is written: {}", chart, reached_text(tile));
  const auto [why, advice] = reason(settings, tile, nearest);
  if (tile.strain_missed)
    user_error("{}: could not be relaxed at strains {:g} x {:g}, nothing is written: {}; {}; {}", chart,
               tile.strain_missed->x, tile.strain_missed->y, why, reached_text(tile), advice);
  if (!tile.relaxed.converged)
    user_error("{}: could not be relaxed, nothing is written: {}; {}; {}", chart, why, reached_text(tile), advice);
  if (tile.gauge_end != GaugeEnd::reached)
    user_error("{}: {} is {:.2f} wales and {:.2f} courses per 10 cm, with --loop {:.4f}", chart,
               gauge_reason(settings, tile), kTenCentimetres * tile.gauge.x, kTenCentimetres * tile.gauge.y,
               kPerMetre * tile.loop_length);
}

std::string report_text(const KnittedTile& tile, double seconds) {
  const Pattern& p = tile.pattern;
  const double diameter = 2 * p.yarn_radius;
  return fmt::format(
      "{}: {} x {} stitches, {} yarn{}\n"
      "period       {:.4f} x {:.4f} mm\n"
      "gauge        {:.2f} wales, {:.2f} courses per 10 cm\n"
      "loop length  {:.4f} mm, {:.3f} yarn diameters of {:.4g} mm\n"
      "closest      {:.4f} yarn diameters\n"
      "forces left  {:.2g}, on the period {:.2g} (bending stiffness / diameter^2)\n"
      "strain       {:.2g} at most\n"
      "relaxed in   {}, {} steps of the best start{}\n"
      "{}",
      p.name, p.stitches.x, p.stitches.y, p.curves.size(), p.curves.size() == 1 ? "" : "s", kPerMetre * p.period.x,
      kPerMetre * p.period.y, kTenCentimetres * tile.gauge.x, kTenCentimetres * tile.gauge.y,
      kPerMetre * tile.loop_length, tile.loop_length / diameter, kPerMetre * diameter, tile.relaxed.closest,
      tile.relaxed.force, tile.relaxed.period_force, tile.relaxed.strain, duration_text(seconds), tile.relaxed.steps,
      tile.tries > 1 ? fmt::format(", the last of {} loop lengths", tile.tries) : "",
      p.strains.empty() ? ""
                        : fmt::format("strains      {} x {}, from {:g} to {:g}\n", p.strains.course.size(),
                                      p.strains.wale.size(), p.strains.course.front(), p.strains.course.back()));
}

std::string report_json(const KnittedTile& tile, double seconds, double processor_seconds) {
  const Pattern& p = tile.pattern;
  nlohmann::ordered_json json;
  json["name"] = p.name;
  json["stitches"] = {p.stitches.x, p.stitches.y};
  json["yarns"] = p.curves.size();
  json["period"] = {p.period.x, p.period.y};
  json["wales_per_10cm"] = kTenCentimetres * tile.gauge.x;
  json["courses_per_10cm"] = kTenCentimetres * tile.gauge.y;
  json["yarn_thickness"] = 2 * p.yarn_radius;
  json["loop_length"] = tile.loop_length;
  json["closest"] = tile.relaxed.closest;
  json["force"] = tile.relaxed.force;
  json["period_force"] = tile.relaxed.period_force;
  json["force_wanted"] = tile.force_wanted;
  json["strain"] = tile.relaxed.strain;
  json["energy"] = tile.relaxed.energy;
  json["steps"] = tile.relaxed.steps;
  json["loop_lengths_tried"] = tile.tries;
  json["seconds"] = seconds;
  json["processor_seconds"] = processor_seconds;  // of all threads
  return json.dump(1) + "\n";
}

}  // namespace

int run_knit(const KnitArgs& args) {
  const StitchChart chart = read_chart(args.chart);
  // Everything that can be refused is refused before the long work starts.
  if (args.output.extension() != ".json")
    user_error("{}: a tile is written as .json; give such a name", args.output.string());
  // Charts are .json too, and the tile would take the place of the one it is made of.
  std::error_code missing;
  if (std::filesystem::equivalent(args.chart, args.output, missing))
    user_error("{}: is the chart itself; give the tile another name", args.output.string());
  if (args.json.lexically_normal() == args.output.lexically_normal())
    user_error("{}: is the tile; give the report another name", args.json.string());
  require_writable_path(args.output);
  if (!args.json.empty() && args.json != "-") require_writable_path(args.json);
  KnitSettings settings = args.settings;
  if (!args.period.empty()) settings.period = period_of(args.period);
  if (args.loop_diameters > 0) settings.loop_length = args.loop_diameters * settings.yarn_thickness;
  catch_stop_signals();
  const auto start = std::chrono::steady_clock::now();
  const std::clock_t processor_start = std::clock();
  Progress bar("knit", args.quiet);
  const KnittedTile tile = knit_tile(chart, settings, [&](double share) {
    bar.update(share);
    return !stop_requested();
  });
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const double processor_seconds = double(std::clock() - processor_start) / CLOCKS_PER_SEC;
  if (!tile.stopped) bar.finish(tile.relaxed.converged ? "" : "not relaxed");
  refuse_if_not_reached(args, settings, tile, period_that_holds(chart, settings, tile, seconds, args.quiet));
  write_pattern_json(tile.pattern, args.output);
  if (args.json == "-")
    fmt::print("{}", report_json(tile, seconds, processor_seconds));
  else if (!args.json.empty())
    write_text_file(args.json, report_json(tile, seconds, processor_seconds));
  if (args.json != "-") fmt::print("{}", report_text(tile, seconds));
  return 0;
}

}  // namespace wale
