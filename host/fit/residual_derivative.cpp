#include "host/fit/residual_derivative.h"

#include <cmath>
#include <numbers>

namespace wale::fit {
namespace {

// Derivative of one picture by a place: of a colour's parameter, of its own channel alone.
Picture picture_derivative(const Picture& picture, const Picture& by, const FitParameter& parameter, double factor) {
  Picture out(picture.width, picture.height);
  const bool scales = parameter.group->gradient == kScalesPictures;
  for (size_t i = 0; i < out.pixels.size(); ++i) {
    if (parameter.group->count == 3 && int(i % 3) != parameter.k) continue;
    out.pixels[i] = float(factor) * (scales ? picture.pixels[i] : by.pixels[i]);
  }
  return out;
}

double square_sum(const PicturePair& pair) {
  double sum = 0;
  for (const Picture* side : {&pair.front, &pair.back})
    for (const float v : side->pixels) sum += double(v) * v;
  return sum;
}

PicturePair moved(const PicturePair& from, const PicturePair& along, double step) {
  PicturePair out = from;
  for (size_t i = 0; i < out.front.pixels.size(); ++i) out.front.pixels[i] += float(step) * along.front.pixels[i];
  for (size_t i = 0; i < out.back.pixels.size(); ++i) out.back.pixels[i] += float(step) * along.back.pixels[i];
  return out;
}

}  // namespace

std::vector<double> residual_derivative(const PairResiduals& residuals, const LitPair::WithGradients& rendered,
                                        const FitParameter& parameter, double place) {
  const ParameterGroup& group = *parameter.group;
  if (group.gradient == kNoGradient) return {};
  const bool scales = group.gradient == kScalesPictures;
  double factor = parameter.steepness(place);
  if (scales) factor *= std::numbers::ln2;
  if (group.slope) factor *= group.slope(parameter.value(place));
  const PicturePair& by = scales ? rendered.pictures : rendered.by[size_t(group.gradient)];
  const PicturePair along{picture_derivative(rendered.pictures.front, by.front, parameter, factor),
                          picture_derivative(rendered.pictures.back, by.back, parameter, factor)};

  // What compares pictures is smooth, and cheap against rendering: along this direction a difference does, of pictures
  // that differ by a hundredth.
  constexpr double kShare = 0.01;
  const double length = std::sqrt(square_sum(along));
  if (!(length > 0)) return std::vector<double>(residuals(rendered.pictures).size(), 0.0);
  const double step = kShare * std::sqrt(square_sum(rendered.pictures)) / length;
  const std::vector<double> upper = residuals(moved(rendered.pictures, along, step));
  const std::vector<double> lower = residuals(moved(rendered.pictures, along, -step));
  std::vector<double> out(upper.size());
  for (size_t i = 0; i < out.size(); ++i) out[i] = (upper[i] - lower[i]) / (2 * step);
  return out;
}

}  // namespace wale::fit
