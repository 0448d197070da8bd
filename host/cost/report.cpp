#include "host/cost/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "geom/error.h"
#include "host/flip.h"
#include "host/progress.h"

namespace wale::cost {
namespace {

using Json = nlohmann::ordered_json;

std::vector<float> clipped(const Picture& picture, double exposure) {
  std::vector<float> out = picture.rgb;
  for (float& v : out) v = std::clamp(v * float(std::exp2(exposure)), 0.0f, 1.0f);
  return out;
}

std::string spread_text(const Spread& s) {
  return fmt::format("{} [{}, {}]", figure(s.middle), figure(s.low), figure(s.high));
}

Json spread_json(const Spread& s) { return {{"median", s.middle}, {"least", s.low}, {"largest", s.high}}; }

Json bias_json(const Bias& b) {
  if (!b.known()) return nullptr;
  return {{"relative_mse", b.relative_mse},
          {"standard_error", b.standard_error},
          {"low", b.low()},
          {"high", b.high()},
          {"resolved", b.resolved()}};
}

// A root of what may be below 0.
double root(double square) { return square > 0 ? std::sqrt(square) : 0; }

// In percent, with blanks so that columns line up.
std::string percent(double share) { return figure(100 * share) + " %"; }

struct Column {
  std::string title;
  bool left = false;
};

std::string table(const std::vector<Column>& columns, const std::vector<std::vector<std::string>>& rows) {
  std::vector<size_t> width;
  for (size_t c = 0; c < columns.size(); ++c) {
    width.push_back(columns[c].title.size());
    for (const auto& row : rows)
      if (c < row.size() && row.size() == columns.size()) width[c] = std::max(width[c], row[c].size());
  }
  std::string out;
  const auto line = [&](const auto& cell) {
    std::string text;
    for (size_t c = 0; c < columns.size(); ++c)
      text += (c ? "  " : "") +
              (columns[c].left ? fmt::format("{:<{}}", cell(c), width[c]) : fmt::format("{:>{}}", cell(c), width[c]));
    text.erase(text.find_last_not_of(' ') + 1);
    out += text + "\n";
  };
  line([&](size_t c) { return columns[c].title; });
  for (const auto& row : rows) {
    if (row.size() == columns.size())
      line([&](size_t c) { return row[c]; });
    else  // two names, and a reason instead of figures
      out += fmt::format("{:<{}}  {:<{}}  {}\n", row[0], width[0], row[1], width[1], row[2]);
  }
  return out;
}

std::string row_note(const CostReport& report, const Level& row) {
  if (report.is_reference(row)) return "the reference";
  if (row.own) return "the scene as it is";
  std::string note = row.beyond ? "beyond the reference" : "";
  const UnitResult* r = report.result(row);
  // Quasi-random points let noise fall faster than 1 / samples, which times to equal noise suppose.
  if (r && r->samples != report.results[0].samples)
    note += fmt::format("{}{} samples a picture, the scene {}", note.empty() ? "" : "; ", r->samples,
                        report.results[0].samples);
  return note;
}

std::string csv_text(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
  return out + "\"";
}

}  // namespace

Spread spread_of(std::vector<double> values) {
  if (values.empty()) bug("spread_of: no value");
  std::sort(values.begin(), values.end());
  const size_t n = values.size();
  return {0.5 * (values[(n - 1) / 2] + values[n / 2]), values.front(), values.back()};
}

double flip_of(const Picture& a, const Picture& b, double exposure) {
  double sum = 0;
  const std::vector<float> map = flip_map(clipped(a, exposure), clipped(b, exposure), a.width, a.height);
  for (const float v : map) sum += v;
  return sum / double(map.size());
}

const UnitResult* CostReport::result(const Level& row) const {
  if (!row.unit) return nullptr;
  const UnitResult& r = results.at(*row.unit);
  return r.left_out.empty() ? &r : nullptr;
}

std::string figure(double value) {
  if (value == 0) return "0";
  if (std::abs(value) >= 99.95 && std::abs(value) < 1e6) return fmt::format("{:.0f}", value);
  return fmt::format("{:#.3g}", value);
}

std::string bias_words(const Bias& bias) {
  if (bias.repetitions < kFewestRepetitions) return fmt::format("too few repetitions ({})", bias.repetitions);
  if (bias.same) return "none: the same pictures";
  if (!bias.known()) return "in too few pixels and repetitions to tell";
  if (!bias.resolved()) return "not resolved, < " + percent(root(bias.limit()));
  return fmt::format("{} [{}, {}]", percent(root(bias.relative_mse)), figure(100 * root(bias.low())),
                     figure(100 * root(bias.high())));
}

std::string bias_of(const CostReport& report, const Level& row) {
  const UnitResult* r = report.result(row);
  return !r ? "" : report.is_reference(row) ? "the reference" : bias_words(r->bias);
}

std::string change_of(const CostReport& report, const Level& row) {
  const UnitResult* r = report.result(row);
  return !r ? "" : *row.unit == 0 ? "the scene" : bias_words(r->change);
}

std::optional<double> radii_of(const CostReport& report, const Level& row) {
  const UnitResult* r = report.result(row);
  if (!r) return {};
  const std::string& own = report.levels.units[*row.unit].geometry;
  for (const Level& other : report.levels.rows)
    if (other.option == row.option && other.unit && report.levels.units[*other.unit].geometry != own) return r->radii;
  return {};
}

std::string report_text(const CostReport& report) {
  std::vector<std::vector<std::string>> rows;
  for (const Level& row : report.levels.rows) {
    const UnitResult* r = report.result(row);
    if (!r) {
      rows.push_back(
          {row.option, row.level, "left out: " + (row.unit ? report.results[*row.unit].left_out : row.skipped)});
      continue;
    }
    const std::optional<double> radii = radii_of(report, row);
    rows.push_back({row.option, row.level, figure(r->cpu_ns.middle), figure(r->wall_ns.middle), figure(r->variance),
                    spread_text(r->time), spread_text(r->equal_noise), bias_of(report, row), change_of(report, row),
                    figure(r->flip), radii ? figure(*radii) : "-", figure(1e-6 * double(r->start.bytes)),
                    figure(r->start.all()), row_note(report, row)});
  }
  std::string out = table({{"option", true},
                           {"level", true},
                           {"CPU ns"},
                           {"wall ns"},
                           {"variance"},
                           {"time a path"},
                           {"time to equal noise"},
                           {"bias (relative RMS)", true},
                           {"change of the scene", true},
                           {"FLIP"},
                           {"radii"},
                           {"MB"},
                           {"start s"},
                           {"", true}},
                          rows);
  out += fmt::format(
      "\nscene      {}: {}\nreference  {}\n           noise of its mean {} (relative RMS); FLIP of its two halves {}\n"
      "device     {} ({})\n"
      "CPU and wall: ns a path. Variance: of one path, over the square of the local mean. Times over those of the "
      "scene as it is, by {} time: median [least, largest] of the "
      "repetitions.\nBias: of the expected picture against the reference's, with its 95 % interval; change: the same "
      "against that of the scene as it is.\nFLIP is of mean pictures, against the reference, and holds noise. Radii: "
      "largest distance of a first hit from "
      "the reference's surface, away from the ends of yarns.\n",
      report.scene, report.base_settings, report.reference_text, percent(report.reference_noise),
      figure(report.reference_flip), report.device, report.driver, report.time_kind);
  out += fmt::format("time       {} of {}{}\n", duration_text(report.seconds_used), duration_text(60 * report.minutes),
                     report.ended.empty() ? "" : "; ended early: " + report.ended);
  return out;
}

std::string report_csv(const CostReport& report) {
  std::string out =
      "option,level,note,repetitions,samples,cpu_ns_per_path,wall_ns_per_path,time,time_least,time_largest,"
      "equal_noise,equal_noise_least,equal_noise_largest,relative_variance_of_a_sample,relative_mse,relative_mse_low,"
      "relative_mse_high,resolved,change,change_low,change_high,change_resolved,flip,radii,bytes,knit_seconds,warp_"
      "seconds,tree_seconds,program_seconds,left_out\n";
  for (const Level& row : report.levels.rows) {
    out += csv_text(row.option) + "," + csv_text(row.level) + "," + csv_text(row_note(report, row)) + ",";
    const UnitResult* r = report.result(row);
    if (!r) {
      out += std::string(26, ',') + csv_text(row.unit ? report.results[*row.unit].left_out : row.skipped) + "\n";
      continue;
    }
    const auto spread = [](const Spread& s) { return fmt::format("{},{},{},", s.middle, s.low, s.high); };
    out += fmt::format("{},{},{},{},", r->repetitions, r->samples, r->cpu_ns.middle, r->wall_ns.middle);
    out += spread(r->time) + spread(r->equal_noise) + fmt::format("{},", r->variance);
    for (const Bias* b : {&r->bias, &r->change})
      out += b->known() ? fmt::format("{},{},{},{},", b->relative_mse, b->low(), b->high(), b->resolved()) : ",,,,";
    const std::optional<double> radii = radii_of(report, row);
    out += fmt::format("{},{},{},{},{},{},{},\n", r->flip, radii ? fmt::format("{}", *radii) : "", r->start.bytes,
                       r->start.knit, r->start.warp, r->start.tree, r->start.programs);
  }
  return out;
}

Json report_json(const CostReport& report) {
  Json out{{"scene", report.scene},
           {"settings", report.base_settings},
           {"command", report.command},
           {"date", report.date},
           {"device", report.device},
           {"driver", report.driver},
           {"times_of", report.time_kind},
           {"size", {report.reference.width, report.reference.height}},
           {"reference", report.reference_text},
           {"reference_noise", report.reference_noise},
           {"reference_flip", report.reference_flip},
           {"minutes", report.minutes},
           {"seconds", report.seconds_used},
           {"ended_early", report.ended},
           {"levels", Json::array()}};
  for (const Level& row : report.levels.rows) {
    Json level{{"option", row.option}, {"level", row.level}, {"note", row_note(report, row)}};
    if (const UnitResult* r = report.result(row)) {
      level["repetitions"] = r->repetitions;
      level["samples"] = r->samples;
      level["cpu_ns_per_path"] = spread_json(r->cpu_ns);
      level["wall_ns_per_path"] = spread_json(r->wall_ns);
      level["time"] = spread_json(r->time);
      level["equal_noise"] = spread_json(r->equal_noise);
      level["relative_variance_of_a_sample"] = r->variance;
      level["bias"] = bias_json(r->bias);
      level["change"] = bias_json(r->change);
      level["flip"] = r->flip;
      const std::optional<double> radii = radii_of(report, row);
      level["radii"] = radii ? Json(*radii) : Json(nullptr);
      level["bytes"] = r->start.bytes;
      level["start_seconds"] = {
          {"knit", r->start.knit}, {"warp", r->start.warp}, {"tree", r->start.tree}, {"programs", r->start.programs}};
    } else {
      level["left_out"] = row.unit ? report.results[*row.unit].left_out : row.skipped;
    }
    out["levels"].push_back(std::move(level));
  }
  return out;
}

}  // namespace wale::cost
