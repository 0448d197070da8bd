#include "host/cost/bias.h"

#include <algorithm>
#include <cmath>

#include "geom/error.h"

namespace wale::cost {
namespace {

// What one pixel says: its part of the relative mean squared error, and the variance of that part.
struct PixelBias {
  double square = 0, variance = 0;
};

// From the differences d of `count` repetitions at one pixel, over its channels. Means over distinct repetitions come
// from sums over all of them: of g_ij = d_i.d_j, g_ij^2, g_ij g_jk and g_ij g_kl, as in Chen and Qin 2010, "A
// Two-Sample Test for High-Dimensional Data".
PixelBias pixel_bias(const double (*d)[3], size_t count) {
  const double n = double(count);
  double sum = 0, squares = 0, chains = 0;
  for (size_t i = 0; i < count; ++i) {
    double row = 0;
    for (size_t j = 0; j < count; ++j) {
      if (j == i) continue;
      const double g = d[i][0] * d[j][0] + d[i][1] * d[j][1] + d[i][2] * d[j][2];
      row += g, squares += g * g;
    }
    sum += row, chains += row * row;
  }
  chains -= squares;                                          // i != k
  const double apart = sum * sum - 4 * chains - 2 * squares;  // all four distinct
  PixelBias out{sum / (n * (n - 1)), 0};
  if (count < size_t(kFewestRepetitions)) return out;
  squares /= n * (n - 1), chains /= n * (n - 1) * (n - 2);
  const double pairs = apart / (n * (n - 1) * (n - 2) * (n - 3));
  const double slope = chains - pairs, trace = squares - 2 * chains + pairs;  // D'CD, tr(C^2)
  out.variance = 4 * slope / n + 2 * trace / (n * (n - 1));
  return out;
}

void require_sizes(std::span<const Picture> pictures, size_t values) {
  for (const Picture& p : pictures)
    if (p.rgb.size() != values || p.pixels() * 3 != values)
      bug("relative_bias: a picture of {} values where {} are needed", p.rgb.size(), values);
}

// `reference(i)`: picture that repetition i of the level is compared with. `known`: variance of its values, or null.
template <typename Reference>
Bias cross(std::span<const Picture> level, const Reference& reference, const std::vector<float>* known,
           const std::vector<double>& weights) {
  Bias out;
  const size_t n = std::min(level.size(), kMostCrossed);
  out.repetitions = int(n);
  if (n < 2) return out;
  double square = 0, variance = 0;
  out.same = true;
  for (size_t p = 0; p < weights.size(); ++p) {
    const double root = std::sqrt(weights[p]);
    double d[kMostCrossed][3], mean[3] = {0, 0, 0};
    for (size_t i = 0; i < n; ++i)
      for (size_t c = 0; c < 3; ++c) {
        d[i][c] = root * (double(level[i].rgb[3 * p + c]) - reference(i).rgb[3 * p + c]);
        mean[c] += d[i][c] / double(n);
        out.same &= d[i][c] == 0;
      }
    PixelBias pixel = pixel_bias(d, n);
    if (known) {
      // All repetitions share the reference's noise, which adds its variance to the square. Taken as the same in all
      // channels, which it nearly is, it moves the square by twice its product with the difference.
      double product = 0;
      for (size_t c = 0; c < 3; ++c) {
        const double v = weights[p] * (*known)[3 * p + c];
        pixel.square -= v;
        product += mean[c] * std::sqrt(v);
      }
      pixel.variance += 4 * product * product;
    }
    square += pixel.square;
    variance += pixel.variance;
  }
  out.relative_mse = square;
  if (out.repetitions >= kFewestRepetitions) out.standard_error = std::sqrt(std::max(0.0, variance));
  return out;
}

}  // namespace

Picture mean_of(std::span<const Picture> pictures) {
  if (pictures.empty()) bug("mean_of: no picture");
  require_sizes(pictures, pictures.front().rgb.size());
  Picture out{pictures.front().width, pictures.front().height, {}};
  out.rgb.resize(pictures.front().rgb.size());
  for (size_t i = 0; i < out.rgb.size(); ++i) {
    double sum = 0;
    for (const Picture& p : pictures) sum += p.rgb[i];
    out.rgb[i] = float(sum / double(pictures.size()));
  }
  return out;
}

std::vector<double> relative_weights(const Picture& reference) {
  const int width = reference.width, height = reference.height;
  const size_t pixels = reference.pixels();
  std::vector<double> grey(pixels), out(pixels);
  double mean = 0;
  for (size_t p = 0; p < pixels; ++p) {
    for (size_t c = 0; c < 3; ++c) grey[p] += reference.rgb[3 * p + c] / 3.0;
    mean += grey[p] / double(pixels);
  }
  // Of a black picture errors are absolute.
  const double least = mean > 0 ? 0.01 * mean * mean : 1;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      double sum = 0;
      int count = 0;
      for (int v = std::max(y - 1, 0); v <= std::min(y + 1, height - 1); ++v)
        for (int u = std::max(x - 1, 0); u <= std::min(x + 1, width - 1); ++u)
          if (u != x || v != y) sum += grey[size_t(v) * size_t(width) + size_t(u)], ++count;
      const double m = count ? sum / count : mean;
      out[size_t(y) * size_t(width) + size_t(x)] = 1 / (m * m + least) / (3 * double(pixels));
    }
  return out;
}

Bias relative_bias(std::span<const Picture> level, std::span<const Picture> reference,
                   const std::vector<double>& weights) {
  require_sizes(level, 3 * weights.size());
  require_sizes(reference, 3 * weights.size());
  const size_t both = std::min(level.size(), reference.size());
  return cross(
      level.first(both), [&](size_t i) -> const Picture& { return reference[i]; }, nullptr, weights);
}

Bias relative_bias(std::span<const Picture> level, const Picture& reference, const std::vector<float>& variance,
                   const std::vector<double>& weights) {
  require_sizes(level, 3 * weights.size());
  require_sizes({&reference, 1}, 3 * weights.size());
  if (variance.size() != reference.rgb.size()) bug("relative_bias: {} variances", variance.size());
  return cross(
      level, [&](size_t) -> const Picture& { return reference; }, &variance, weights);
}

}  // namespace wale::cost
