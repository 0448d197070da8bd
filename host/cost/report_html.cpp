#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/cost/report.h"
#include "host/page_parts.h"
#include "host/progress.h"

namespace wale::cost {
namespace {

constexpr int kShownSide = 256;  // pixels of a picture that are shown: its middle

// The middle of a picture as a PNG in the page; color(pixel, out): three display values in [0,1].
template <typename Color>
std::string shown_tag(const Picture& of, const std::string& what, const Color& color) {
  const int width = std::min(of.width, kShownSide), height = std::min(of.height, kShownSide);
  const int x0 = (of.width - width) / 2, y0 = (of.height - height) / 2;
  std::vector<unsigned char> bytes;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      float display[3];
      color(size_t(y0 + y) * size_t(of.width) + size_t(x0 + x), display);
      for (const float v : display) bytes.push_back(static_cast<unsigned char>(std::lround(255 * v)));
    }
  const int shown = width * std::max(1, kShownSide / std::max(width, height));
  return picture_tag(bytes, width, height, shown, what);
}

std::string look(const CostReport& report, const Picture& picture, const std::string& what) {
  return shown_tag(picture, what, [&](size_t p, float* display) {
    view_transform(&picture.rgb[3 * p], report.exposure, report.view, display);
  });
}

// Blue where the level is darker than the reference, red where it is brighter, white where they agree.
std::string difference(const CostReport& report, const Picture& picture, const std::vector<double>& weights,
                       double range) {
  return shown_tag(picture, "difference", [&](size_t p, float* display) {
    double d = 0;
    for (size_t c = 0; c < 3; ++c) d += (double(picture.rgb[3 * p + c]) - report.reference.rgb[3 * p + c]) / 3;
    d = std::clamp(d * std::sqrt(weights[p] * 3 * double(weights.size())) / range, -1.0, 1.0);
    const float rest = float(1 - std::abs(d));
    display[0] = d > 0 ? 1 - 0.2f * float(d) : rest;
    display[1] = rest;
    display[2] = d < 0 ? 1 + 0.2f * float(d) : rest;
  });
}

// A round figure that most of the largest resolved differences reach.
double range_of(const CostReport& report) {
  double largest = 0;
  for (const UnitResult& r : report.results)
    if (r.left_out.empty() && r.bias.resolved())
      largest = std::max(largest, std::sqrt(std::max(0.0, r.bias.relative_mse)));
  for (const double range : {0.02, 0.05, 0.1, 0.2, 0.5})
    if (largest <= range) return range;
  return 1;
}

std::string spread_cell(const Spread& s) {
  return fmt::format("<td>{}<small> {} to {}</small></td>", figure(s.middle), figure(s.low), figure(s.high));
}

std::string table_row(const CostReport& report, const Level& row) {
  const std::string classes = row.own ? " class=own" : "";
  const std::string names =
      fmt::format("<tr{}><td>{}</td><td>{}</td>", classes, html_text(row.option), html_text(row.level));
  const UnitResult* r = report.result(row);
  if (!r)
    return names + fmt::format("<td class=out colspan=12>left out: {}</td></tr>\n",
                               html_text(row.unit ? report.results[*row.unit].left_out : row.skipped));
  const std::optional<double> radii = radii_of(report, row);
  std::string bias = html_text(bias_of(report, row));
  if (row.beyond) bias += "<small> (beyond the reference)</small>";
  return names +
         fmt::format("<td>{}</td><td>{}</td><td>{}</td>", figure(r->cpu_ns.middle), figure(r->wall_ns.middle),
                     figure(r->variance)) +
         spread_cell(r->time) + spread_cell(r->equal_noise) +
         fmt::format("<td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n", bias,
                     html_text(change_of(report, row)), figure(r->flip), radii ? figure(*radii) : "&ndash;",
                     figure(1e-6 * double(r->start.bytes)), figure(r->start.all()),
                     fmt::format("{} x {}", r->repetitions, r->samples));
}

constexpr const char* kStyle =
    R"(body{font:15px/1.45 sans-serif;color:#222;max-width:1180px;margin:2em auto;padding:0 1em}
table{border-collapse:collapse;font-size:13px;width:100%}td,th{padding:3px 8px;border-bottom:1px solid #ddd;text-align:right;vertical-align:top}
td:nth-child(1),td:nth-child(2),th:nth-child(1),th:nth-child(2),td.out{text-align:left}td:nth-child(8),td:nth-child(9),th:nth-child(8),th:nth-child(9){text-align:left}
tr.own{background:#eef4fa}.out,small{color:#777}.levels{display:flex;flex-wrap:wrap;gap:14px}figure{margin:0}figcaption{font-size:13px;max-width:530px}
img{image-rendering:pixelated;margin-right:4px}svg{max-width:100%;height:auto})";

}  // namespace

std::string report_html(const CostReport& report, const std::string& plot_svg) {
  std::string out =
      "<!doctype html>\n<html lang=en><meta charset=utf-8><title>What accuracy costs: " + html_text(report.scene) +
      "</title>\n<style>" + kStyle + "</style>\n";
  out += fmt::format(
      "<h1>What accuracy costs: {}</h1>\n<p>{} x {} pixels, {} ({}), {}.<br><code>{}</code><br>{} of {}{}.</p>\n",
      html_text(report.scene), report.reference.width, report.reference.height, html_text(report.device),
      html_text(report.driver), html_text(report.date), html_text(report.command), duration_text(report.seconds_used),
      duration_text(60 * report.minutes), report.ended.empty() ? "" : "; ended early: " + html_text(report.ended));
  out += fmt::format("<p>The scene as it is: {}.<br>The reference: {}; noise of its mean {} % (relative RMS).</p>\n",
                     html_text(report.base_settings), html_text(report.reference_text),
                     figure(100 * report.reference_noise));
  out += plot_svg.substr(std::min(plot_svg.find("<svg"), plot_svg.size()));
  out +=
      "\n<p>Each level changes one option of the scene. A level on the grey stair is beaten by no other in both price "
      "and bias; a ring with an arrow is one whose bias noise hides: it lies at its upper limit.</p>\n"
      "<h2>Levels</h2>\n<table><tr><th>option<th>level<th>CPU ns a path<th>wall ns<th>variance<th>time a path<th>time "
      "to equal "
      "noise<th>bias, relative RMS<th>change of the scene<th>FLIP<th>radii<th>MB<th>start s<th>samples</tr>\n";
  for (const Level& row : report.levels.rows) out += table_row(report, row);
  out += fmt::format(
      "</table>\n<p>Times are over those of the scene as it is, by {} time: median, least and largest of the "
      "repetitions, which take turns. Time to equal noise is time a path times variance of a sample. Bias is the root "
      "of "
      "the relative mean squared error of the expected picture with its 95 % interval: differences from the reference "
      "are multiplied across independent repetitions, so that noise adds nothing; change is the same against the scene "
      "as "
      "it is. FLIP is of mean pictures and holds "
      "their noise; two halves of the reference differ by {}. Radii: largest distance of a first hit from the surface "
      "of the reference&rsquo;s plies, in ply radii, away from the ends of yarns; only where the option changes "
      "geometry. MB on the device. Start: "
      "knitting, warping, tree, programs.</p>\n",
      report.time_kind, figure(report.reference_flip));
  std::string hidden;
  for (const Level& row : report.levels.rows)
    if (const UnitResult* r = report.result(row); r && !r->bias.resolved() && !report.is_reference(row))
      hidden +=
          fmt::format("<li>{} {}: {}\n", html_text(row.option), html_text(row.level), html_text(bias_of(report, row)));
  if (!hidden.empty()) out += "<h2>Not resolved from noise</h2>\n<ul>" + hidden + "</ul>\n";
  const double range = range_of(report);
  const std::vector<double> weights = relative_weights(report.reference);
  out += fmt::format(
      "<h2>Pictures</h2>\n<p>Left the level, right its difference from the reference: red is brighter, blue darker, "
      "full "
      "colour at {} % of the local mean.</p>\n<div class=levels>\n<figure>{}<figcaption>the "
      "reference</figcaption></figure>\n",
      figure(100 * range), look(report, report.reference, "the reference"));
  std::vector<bool> shown(report.results.size(), false);
  for (const Level& row : report.levels.rows) {
    const UnitResult* r = report.result(row);
    if (!r || report.is_reference(row) || shown[*row.unit]) continue;
    shown[*row.unit] = true;
    out += fmt::format("<figure>{}{}<figcaption>{} {}: {}, time {}</figcaption></figure>\n",
                       look(report, r->mean, "the level"), difference(report, r->mean, weights, range),
                       html_text(row.option), html_text(row.level), html_text(bias_of(report, row)),
                       figure(r->equal_noise.middle));
  }
  return out + "</div>\n</html>\n";
}

}  // namespace wale::cost
