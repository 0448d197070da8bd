#include "host/cost/bias.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geom/error.h"

namespace wale::cost {
namespace {

constexpr size_t kMostRepetitions = 16;

// What one pixel says: its part of the relative mean squared error, and the variance of that part.
struct PixelBias {
  double square = 0, variance = 0;
};

// Scalar products of the repetitions' differences at one pixel, over its channels.
class Gram {
 public:
  Gram(const double (*d)[3], size_t count) : count_(count) {
    for (size_t i = 0; i < count; ++i)
      for (size_t j = 0; j <= i; ++j)
        g_[i][j] = g_[j][i] = d[i][0] * d[j][0] + d[i][1] * d[j][1] + d[i][2] * d[j][2];
  }

  PixelBias bias() const {
    const double n = double(count_);
    double square = 0, trace = 0, slope = 0;
    size_t quartets = 0;
    for (size_t a = 0; a < count_; ++a)
      for (size_t b = 0; b < a; ++b) {
        square += 2 * g_[a][b];
        for (size_t c = 0; c < a; ++c)
          for (size_t d = 0; d < c; ++d) {
            if (c == b || d == b) continue;
            // (d_a - d_b).(d_c - d_d) holds the noise alone: the mean of its square is 4 tr(C^2).
            const double noise = g_[a][c] - g_[a][d] - g_[b][c] + g_[b][d];
            trace += noise * noise / 4;
            // d_a.(d_c - d_d) times d_b.(d_c - d_d) has the mean 2 D'CD; and so with the pairs exchanged.
            slope += ((g_[a][c] - g_[a][d]) * (g_[b][c] - g_[b][d]) + (g_[c][a] - g_[c][b]) * (g_[d][a] - g_[d][b])) / 4;
            ++quartets;
          }
      }
    PixelBias out{square / (n * (n - 1)), 0};
    if (quartets > 0) {
      trace /= double(quartets), slope /= double(quartets);
      out.variance = 4 * slope / n + 2 * trace / (n * (n - 1));
    }
    return out;
  }

 private:
  size_t count_;
  double g_[kMostRepetitions][kMostRepetitions];
};

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
  const size_t n = std::min(level.size(), kMostRepetitions);
  out.repetitions = int(n);
  if (n < 2) return out;
  double square = 0, variance = 0;
  for (size_t p = 0; p < weights.size(); ++p) {
    const double root = std::sqrt(weights[p]);
    double d[kMostRepetitions][3], mean[3] = {0, 0, 0};
    for (size_t i = 0; i < n; ++i)
      for (size_t c = 0; c < 3; ++c) {
        d[i][c] = root * (double(level[i].rgb[3 * p + c]) - reference(i).rgb[3 * p + c]);
        mean[c] += d[i][c] / double(n);
      }
    PixelBias pixel = Gram(d, n).bias();
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
  if (out.known()) out.standard_error = std::sqrt(std::max(0.0, variance));
  return out;
}

}  // namespace

bool Bias::known() const { return repetitions >= kFewestRepetitions; }

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
  return cross(level.first(both), [&](size_t i) -> const Picture& { return reference[i]; }, nullptr, weights);
}

Bias relative_bias(std::span<const Picture> level, const Picture& reference, const std::vector<float>& variance,
                   const std::vector<double>& weights) {
  require_sizes(level, 3 * weights.size());
  require_sizes({&reference, 1}, 3 * weights.size());
  if (variance.size() != reference.rgb.size()) bug("relative_bias: {} variances", variance.size());
  return cross(level, [&](size_t) -> const Picture& { return reference; }, &variance, weights);
}

}  // namespace wale::cost
