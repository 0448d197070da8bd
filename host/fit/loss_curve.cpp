#include "host/fit/loss_curve.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace wale::fit {
namespace {

constexpr double kWidth = 860, kHeight = 300, kLeft = 70, kBottom = 40, kMargin = 14;
// Okabe and Ito (2008): told apart without colour vision too.
constexpr std::array<const char*, 6> kColors = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"};

}  // namespace

std::string loss_curve_svg(const FitJournal& journal) {
  double low = INFINITY, high = 0;
  for (const FitStep& s : journal.steps)
    if (s.start >= 0 && s.loss > 0) low = std::min(low, s.loss), high = std::max(high, s.loss);
  if (!(high > 0)) return {};
  const double first = std::floor(std::log10(low)), last = std::max(first + 1, std::ceil(std::log10(high)));
  const double count = double(std::max<size_t>(1, journal.steps.size()));
  const auto x = [&](size_t i) { return kLeft + (kWidth - kLeft - kMargin) * (double(i) + 1) / count; };
  const auto y = [&](double loss) {
    return kMargin + (kHeight - kBottom - kMargin) * (last - std::log10(std::max(loss, low))) / (last - first);
  };
  std::string out = fmt::format(
      "<svg viewBox=\"0 0 {} {}\" width=\"{}\" role=img aria-label=\"loss over pairs of renders\" "
      "font-family=sans-serif font-size=12>\n",
      kWidth, kHeight, kWidth);
  for (double e = first; e <= last; ++e)
    out += fmt::format(
        "<line x1={:.1f} x2={:.1f} y1={:.1f} y2={:.1f} stroke=#ddd /><text x={:.1f} y={:.1f} "
        "text-anchor=end>1e{:g}</text>\n",
        kLeft, kWidth - kMargin, y(std::pow(10, e)), y(std::pow(10, e)), kLeft - 6, y(std::pow(10, e)) + 4, e);
  out += fmt::format("<text x={:.1f} y={:.1f} text-anchor=middle>pairs of renders ({})</text>\n", (kLeft + kWidth) / 2,
                     kHeight - 10, journal.steps.size());
  int most = 0;
  for (const FitStep& s : journal.steps) most = std::max(most, s.start + 1);
  for (int k = 0; k < most; ++k) {
    const char* color = kColors[size_t(k) % kColors.size()];
    std::string line;
    double least = INFINITY;
    for (size_t i = 0; i < journal.steps.size(); ++i) {
      const FitStep& s = journal.steps[i];
      if (s.start != k || !(s.loss > 0)) continue;
      least = std::min(least, s.loss);
      line += fmt::format("{:.1f},{:.1f} ", x(i), y(least));
      out += fmt::format("<circle cx={:.1f} cy={:.1f} r=2 fill={} opacity=0.5 />\n", x(i), y(s.loss), color);
    }
    out += fmt::format("<polyline points=\"{}\" fill=none stroke={} stroke-width=2 />\n", line, color);
  }
  return out + "</svg>\n";
}

}  // namespace wale::fit
