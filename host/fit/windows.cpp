#include "host/fit/windows.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>

namespace wale::fit {
namespace {

using Complex = std::complex<double>;

std::vector<double> taper(int size) {
  std::vector<double> weights(static_cast<size_t>(size));
  double sum = 0;
  for (int i = 0; i < size; ++i) {
    const double s = std::sin(std::numbers::pi * (i + 0.5) / size);
    sum += weights[size_t(i)] = s * s;
  }
  for (double& w : weights) w /= sum;
  return weights;
}

// In place, rows then columns.
void transform(std::vector<Complex>& values, size_t width, size_t height) {
  Eigen::FFT<double> fft;
  std::vector<Complex> line, out;
  for (size_t y = 0; y < height; ++y) {
    line.assign(values.begin() + long(y * width), values.begin() + long((y + 1) * width));
    fft.fwd(out, line);
    std::copy(out.begin(), out.end(), values.begin() + long(y * width));
  }
  line.resize(height);
  for (size_t x = 0; x < width; ++x) {
    for (size_t y = 0; y < height; ++y) line[y] = values[y * width + x];
    fft.fwd(out, line);
    for (size_t y = 0; y < height; ++y) values[y * width + x] = out[y];
  }
}

double luminance(const float* rgb) { return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]; }

// Cycles a pixel of a bin, without sign.
double frequency(size_t bin, int size) { return double(std::min(bin, size_t(size) - bin)) / size; }

}  // namespace

std::vector<Window> windows(int width, int height, int count) {
  const int across = std::max(1, 2 * width / (count + 1)), down = std::max(1, 2 * height / (count + 1));
  const auto start = [&](int i, int size, int part) {
    return count == 1 ? (size - part) / 2 : int(std::lround(double(i) * (size - part) / (count - 1)));
  };
  std::vector<Window> all;
  for (int j = 0; j < count; ++j)
    for (int i = 0; i < count; ++i)
      all.push_back({start(i, width, across), start(j, height, down), across, down, taper(across), taper(down)});
  return all;
}

Window whole_picture(int width, int height) {
  return {0,
          0,
          width,
          height,
          std::vector<double>(size_t(width), 1.0 / width),
          std::vector<double>(size_t(height), 1.0 / height)};
}

ColorMoments color_moments(const Picture& picture, const Window& window) {
  ColorMoments moments;
  const auto each = [&](const auto& visit) {
    for (int j = 0; j < window.height; ++j)
      for (int i = 0; i < window.width; ++i) visit(window.weight(i, j), picture.at(window.x + i, window.y + j));
  };
  each([&](double weight, const float* rgb) {
    for (size_t c = 0; c < 3; ++c) moments.mean[c] += weight * double(rgb[c]);
  });
  each([&](double weight, const float* rgb) {
    for (size_t a = 0; a < 3; ++a)
      for (size_t b = 0; b < 3; ++b)
        moments.covariance[3 * a + b] +=
            weight * (double(rgb[a]) - moments.mean[a]) * (double(rgb[b]) - moments.mean[b]);
  });
  return moments;
}

std::vector<double> band_deviations(const Picture& picture, const Window& window) {
  const size_t width = size_t(window.width), height = size_t(window.height);
  double mean = 0, squared_weights = 0;
  for (int j = 0; j < window.height; ++j)
    for (int i = 0; i < window.width; ++i) {
      mean += window.weight(i, j) * luminance(picture.at(window.x + i, window.y + j));
      squared_weights += window.weight(i, j) * window.weight(i, j);
    }
  std::vector<Complex> values(width * height);
  for (int j = 0; j < window.height; ++j)
    for (int i = 0; i < window.width; ++i)
      values[size_t(j) * width + size_t(i)] =
          window.weight(i, j) * (luminance(picture.at(window.x + i, window.y + j)) - mean);
  transform(values, width, height);
  const auto band_of = [](double f) { return std::max(0.0, std::floor(-2 * std::log2(f) - 1)); };
  const size_t slowest = size_t(band_of(1.0 / std::max(2, std::min(window.width, window.height))));
  std::vector<double> bands(slowest + 1);
  for (size_t y = 0; y < height; ++y)
    for (size_t x = 0; x < width; ++x) {
      const double f = std::hypot(frequency(x, window.width), frequency(y, window.height));
      const size_t band = f > 0 ? std::min(slowest, size_t(band_of(f))) : slowest;
      bands[band] += std::norm(values[y * width + x]);
    }
  // Parseval's theorem, and the taper's own loss of power.
  for (double& band : bands) band = std::sqrt(band / (double(width * height) * squared_weights));
  return bands;
}

}  // namespace wale::fit
