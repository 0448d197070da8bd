#include "host/fit/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/fit/loss_curve.h"
#include "host/page_parts.h"
#include "host/progress.h"

namespace wale::fit {
namespace {

constexpr int kShownSide = 320;      // pixels of a picture on the page, at least
constexpr double kFullColour = 0.5;  // difference of the photograph's mean that is shown in full colour

std::string figure(double value) { return fmt::format("{:.3g}", value); }

int shown_width(const Picture& of) { return of.width * std::max(1, kShownSide / std::max(of.width, of.height)); }

std::string look(const Picture& picture, const std::string& what) {
  std::vector<unsigned char> bytes;
  for (size_t i = 0; i < picture.count(); ++i) {
    float display[3];
    view_transform(&picture.pixels[3 * i], 0, "srgb", display);
    for (const float v : display) bytes.push_back(static_cast<unsigned char>(std::lround(255 * v)));
  }
  return picture_tag(bytes, picture.width, picture.height, shown_width(picture), what);
}

// Red where the render is brighter, blue where it is darker, white where they agree.
void difference_color(const float* render, const float* photograph, double unit, float* out) {
  double d = 0;
  for (size_t c = 0; c < 3; ++c) d += (double(render[c]) - double(photograph[c])) / 3;
  const float x = float(std::clamp(d / (kFullColour * std::max(unit, 1e-9)), -1.0, 1.0)), rest = 1 - std::abs(x);
  out[0] = x > 0 ? 1.0f : rest;
  out[1] = rest;
  out[2] = x < 0 ? 1.0f : rest;
}

std::string difference(const Picture& photograph, const Picture& render) {
  const double unit = brightness(photograph);
  std::vector<unsigned char> bytes;
  for (size_t i = 0; i < render.count(); ++i) {
    float color[3];
    difference_color(&render.pixels[3 * i], &photograph.pixels[3 * i], unit, color);
    for (const float v : color) bytes.push_back(static_cast<unsigned char>(std::lround(255 * v)));
  }
  return picture_tag(bytes, render.width, render.height, shown_width(render), "difference");
}

std::string mean_text(const Picture& of) {
  double mean[3] = {0, 0, 0};
  for (size_t i = 0; i < of.count(); ++i)
    for (size_t c = 0; c < 3; ++c) mean[c] += of.pixels[3 * i + c] / double(of.count());
  return fmt::format("{} {} {}", figure(mean[0]), figure(mean[1]), figure(mean[2]));
}

std::string side_row(const char* side, const Picture& photograph, const Picture& render) {
  if (photograph.count() == 0) return {};
  return fmt::format(
      "<h3>Lit from the {0}</h3>\n<div class=row><figure>{1}<figcaption>photograph, mean {2}</figcaption></figure>"
      "<figure>{3}<figcaption>render, mean {4}</figcaption></figure><figure>{5}<figcaption>difference: red is "
      "brighter, "
      "blue darker, full colour at {6:g} % of the mean</figcaption></figure></div>\n",
      side, look(photograph, fmt::format("photograph lit from the {}", side)), mean_text(photograph),
      look(render, fmt::format("render lit from the {}", side)), mean_text(render), difference(photograph, render),
      100 * kFullColour);
}

constexpr const char* kStyle =
    R"(body{font:15px/1.45 sans-serif;color:#222;max-width:1080px;margin:2em auto;padding:0 1em}
table{border-collapse:collapse;font-size:14px}td,th{padding:3px 10px;border-bottom:1px solid #ddd;text-align:right}
td:first-child,th:first-child,td:last-child,th:last-child{text-align:left}.row{display:flex;flex-wrap:wrap;gap:12px}
figure{margin:0;width:32%}figcaption{font-size:13px;color:#555}img{image-rendering:pixelated;width:100%}tr.bad{background:#fbeeee}
svg{max-width:100%;height:auto})";

std::string remark(const FittedParameter& p) {
  if (p.assessed && !p.determined) return "not determined by these photographs";
  return p.at_bound ? "at its bound" : "";
}

std::string table_row(const FitParameter& parameter, const FittedParameter& p) {
  const std::string range = p.low        ? fmt::format("{} to {}", figure(*p.low), figure(*p.high))
                            : p.assessed ? "any"
                                         : "not known";
  return fmt::format("<tr{}><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
                     p.determined || !p.assessed ? "" : " class=bad", parameter.name(), figure(p.value), range,
                     figure(p.start), fmt::format("{} to {}", figure(parameter.low), figure(parameter.high)),
                     parameter.group->unit, remark(p));
}

std::string start_name(size_t i) {
  return i == 0 ? std::string("the scene's material") : fmt::format("place {}", i + 1);
}

void put_side(Image& into, int row, const Picture& photograph, const Picture& render) {
  const double unit = brightness(photograph);
  for (int y = 0; y < photograph.height; ++y)
    for (int x = 0; x < photograph.width; ++x) {
      const float* a = photograph.at(x, y);
      const float* b = render.at(x, y);
      float d[3];
      difference_color(b, a, unit, d);
      for (size_t c = 0; c < 3; ++c) {
        into.at(x, row + y)[c] = a[c];
        into.at(x + photograph.width, row + y)[c] = b[c];
        into.at(x + 2 * photograph.width, row + y)[c] = d[c];
      }
    }
}

}  // namespace

std::string parameter_line(const FitParameter& parameter, const FittedParameter& p) {
  const std::string unit = *parameter.group->unit ? std::string(" ") + parameter.group->unit : "";
  const std::string range = p.low ? fmt::format(" ({} to {})", figure(*p.low), figure(*p.high)) : "";
  const std::string more = remark(p);
  return fmt::format("{} {}{}{}{}", parameter.name(), figure(p.value), unit, range, more.empty() ? "" : ", " + more);
}

std::vector<std::string> parameter_warnings(const FitSettings& settings, const FitResult& result) {
  std::vector<std::string> out;
  const size_t count = result.parameters.size();
  if (!std::all_of(result.parameters.begin(), result.parameters.end(), [](const auto& p) { return p.assessed; }))
    out.push_back(
        fmt::format("no ranges: they come from how windows of the photographs differ, and the loss has too few of them "
                    "for {} parameter{}, at least {}; low_pass and gradient have more",
                    count, count == 1 ? "" : "s", count + 1));
  for (size_t k = 0; k < count; ++k) {
    const FittedParameter& p = result.parameters[k];
    const FitParameter& parameter = settings.parameters[k];
    if (p.assessed && !p.determined)
      out.push_back(fmt::format("{}: these photographs do not determine it; {} is where the fit came to rest",
                                parameter.name(), figure(p.value)));
    else if (p.at_bound)
      out.push_back(
          fmt::format("{}: {} is its bound; the photographs may ask for more than its bounds, {:g} to {:g}, allow",
                      parameter.name(), figure(p.value), parameter.low, parameter.high));
  }
  for (const auto& [a, b] : result.alike)
    out.push_back(fmt::format("{} and {} change the pictures alike: one of them, given, would make the other surer",
                              settings.parameters[a].name(), settings.parameters[b].name()));
  return out;
}

Image side_by_side(const PicturePair& photographs, const PicturePair& renders) {
  const Picture& any = photographs.front.count() ? photographs.front : photographs.back;
  const bool both = photographs.front.count() && photographs.back.count();
  Image out;
  out.width = 3 * any.width;
  out.height = (both ? 2 : 1) * any.height;
  out.channels = {"R", "G", "B"};
  out.pixels.resize(size_t(out.width) * size_t(out.height) * 3);
  if (photographs.front.count()) put_side(out, 0, photographs.front, renders.front);
  if (photographs.back.count()) put_side(out, both ? any.height : 0, photographs.back, renders.back);
  return out;
}

std::string report_html(const FitReport& report, const FitSettings& settings, const FitJournal& journal,
                        const FitResult& result) {
  std::string out =
      "<!doctype html>\n<html lang=en><meta charset=utf-8><title>A fitted material: " + html_text(report.scene) +
      "</title>\n<style>" + kStyle + "</style>\n";
  out += fmt::format(
      "<h1>A material fitted to photographs</h1>\n<p>{}, {} pairs of renders of {} samples a pixel, {}, "
      "{}.<br><code>{}</code></p>\n",
      html_text(report.scene), journal.steps.size(), settings.samples, duration_text(journal.seconds),
      html_text(report.device), html_text(report.command));
  if (!report.warnings.empty()) {
    out += "<ul>\n";
    for (const std::string& warning : report.warnings) out += "<li>" + html_text(warning) + "\n";
    out += "</ul>\n";
  }
  out += side_row("front", report.photographs.front, result.pictures.front);
  out += side_row("back", report.photographs.back, result.pictures.back);
  out +=
      "<h2>Parameters</h2>\n<table><tr><th>parameter<th>value<th>two standard "
      "deviations<th>start<th>bounds<th>unit<th></tr>\n";
  for (size_t k = 0; k < result.parameters.size(); ++k) out += table_row(settings.parameters[k], result.parameters[k]);
  out += fmt::format(
      "</table>\n<p>Ranges come from how parts of the photographs differ in what they ask of each parameter, all "
      "others "
      "free: noise, and what the model cannot do in one part as in another. What is wrong everywhere alike, as a wrong "
      "exposure or yarn, is in none of them.</p>\n<h2>Loss</h2>\n<p>{}.</p>\n<p>At the end {}, without the squares "
      "that noise of the renders adds, {}.</p>\n{}",
      html_text(report.loss), figure(result.best.loss), figure(result.render_noise), loss_curve_svg(journal));
  out += "<table><tr><th>start<th>loss there<th>loss at the end<th>pairs of renders<th></tr>\n";
  for (size_t i = 0; i < journal.finished.size(); ++i) {
    const FitStart& s = journal.finished[i];
    out += fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n", start_name(i),
                       figure(s.first_loss), figure(s.loss), s.evaluations, s.converged ? "" : "had not converged");
  }
  return out + "</table>\n</html>\n";
}

}  // namespace wale::fit
