// Closed-form plain knit after Crane's "plain knit yarn", the side of the Vs towards +z:
//   g(t) = (t + a sin 2t, h cos t, -d cos 2t),  rows `row` apart, one stitch per 2 pi.
// Crane draws a = 3/2, h = 4, d = 1, row = 9/2; relaxed knits have flatter stitches (a course of 0.53 to 0.61 wales).
// h = 3, d = 1.1, row = 3.6 keep the topology (the rows stay apart on the straight way from one to the other) and the
// same distance between rows, at a course of 0.57 wales.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "geom/error.h"
#include "geom/pattern.h"

namespace wale {
namespace {

constexpr double kRound = 1.5, kHeight = 3, kDepth = 1.1, kRow = 3.6;
constexpr double kTwoPi = 2 * std::numbers::pi;

dvec3 loop(double t) { return {t + kRound * std::sin(2 * t), kHeight * std::cos(t), -kDepth * std::cos(2 * t)}; }

/// Smallest distance between the loop and itself `rows` further up: a grid over both parameters, refined about its best
/// point. Within one row, points less than kNeck apart along the loop are neighbours, not contacts.
double closest(int rows) {
  constexpr double kNeck = 1.5;
  double best = INFINITY, best_s = 0, best_t = 0;
  double centre_s = 0, centre_t = 0, half = kTwoPi;
  for (int round = 0; round < 12; ++round, half /= 8) {
    constexpr int kSteps = 64;
    double s[2 * kSteps + 1], t[2 * kSteps + 1];
    dvec3 on_s[2 * kSteps + 1], on_t[2 * kSteps + 1];
    for (int i = 0; i <= 2 * kSteps; ++i) {
      s[i] = centre_s + half * (i - kSteps) / kSteps;
      t[i] = centre_t + half * (i - kSteps) / kSteps;
      on_s[i] = loop(s[i]);
      on_t[i] = loop(t[i]) + dvec3(0, rows * kRow, 0);
    }
    for (int i = 0; i <= 2 * kSteps; ++i)
      for (int j = 0; j <= 2 * kSteps; ++j) {
        if (rows == 0 && std::abs(s[i] - t[j]) < kNeck) continue;
        const double distance = glm::distance(on_s[i], on_t[j]);
        if (distance < best) best = distance, best_s = s[i], best_t = t[j];
      }
    centre_s = best_s;
    centre_t = best_t;
  }
  return best;
}

}  // namespace

Pattern stockinette_pattern(double wale_width) {
  if (!(wale_width > 0) || !std::isfinite(wale_width))
    user_error("a stitch {} m wide: it must be positive", wale_width);
  const double scale = wale_width / kTwoPi;
  Pattern pattern;
  pattern.name = "stockinette";
  pattern.period = {wale_width, kRow * scale};
  pattern.stitches = {1, 1};
  pattern.yarn_radius = std::min({closest(0), closest(1), closest(2)}) / 2 * scale;
  constexpr int kPoints = 64;  // the spline then follows the closed form to 1e-4 of a yarn radius
  PatternCurve curve;
  for (int i = 0; i < kPoints; ++i) curve.points.push_back(scale * loop(kTwoPi * i / kPoints - std::numbers::pi));
  curve.points.push_back(curve.points.front() + dvec3(wale_width, 0, 0));
  pattern.curves.push_back(std::move(curve));
  return pattern;
}

}  // namespace wale
