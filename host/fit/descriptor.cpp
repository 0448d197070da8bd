#include "host/fit/descriptor.h"

#include <algorithm>
#include <cmath>

#include "host/fit/resample.h"
#include "host/fit/windows.h"

namespace wale::fit {
namespace {

constexpr int kSmallestLevel = 4;  // pixels

std::vector<Window> windows_of(const Picture& picture, const DescriptorOptions& options) {
  if (options.alignment == Alignment::aligned) return {whole_picture(picture.width, picture.height)};
  return windows(picture.width, picture.height, options.windows);
}

// Levels at which even a window has some pixels.
std::vector<Picture> levels_of(const Picture& picture, const DescriptorOptions& options) {
  const int windows = options.alignment == Alignment::aligned ? 1 : options.windows;
  return pyramid(picture, options.levels, kSmallestLevel * windows);
}

std::string level_name(size_t level) { return level == 0 ? "full size" : "1/" + std::to_string(size_t(1) << level); }

// Weights all equal, units from the values where there are none yet.
Blocks finished(std::vector<Block> blocks, const Picture& picture) {
  const double shade = brightness(picture);
  for (Block& block : blocks) {
    block.weight = 1.0 / double(blocks.size());
    if (block.unit == 0) block.unit = unit_of(block.values, shade);
  }
  return blocks;
}

// What contrast is measured by: each channel's own mean, and a little of all of them where it is hardly there.
std::array<double, 3> shades_of(const std::array<double, 3>& mean) {
  const double grey = (mean[0] + mean[1] + mean[2]) / 3;
  return {mean[0] + kLeastUnit * grey, mean[1] + kLeastUnit * grey, mean[2] + kLeastUnit * grey};
}

// Logarithm of a deviation over a shade: a factor e counts as much as a picture that is black. Below kLeastContrast all
// are alike.
float contrast(double deviation, double shade) {
  return float(std::log(kLeastContrast + (shade > 0 ? deviation / shade : 0.0)));
}

Block pixels_block(std::string name, std::vector<float> values, int passes) {
  return {std::move(name), 0, 0, std::move(values), passes, 0};
}

Block windows_block(std::string name, std::vector<float> values, size_t windows) {
  return {std::move(name), 0, 0, std::move(values), 1, int(windows)};
}

Block contrast_block(std::string name, std::vector<float> values, size_t windows) {
  Block block = windows_block(std::move(name), std::move(values), windows);
  block.unit = 1;
  return block;
}

// Contrast of each channel, and the correlations of R with G, G with B, and B with R.
void append_spread(const ColorMoments& moments, std::vector<float>& values) {
  const auto& m = moments.covariance;
  const std::array<double, 3> shades = shades_of(moments.mean);
  std::array<double, 3> deviation{};
  for (size_t c = 0; c < 3; ++c) deviation[c] = std::sqrt(std::max(0.0, m[4 * c]));
  for (size_t c = 0; c < 3; ++c) values.push_back(contrast(deviation[c], shades[c]));
  for (size_t c = 0; c < 3; ++c) {
    const size_t d = (c + 1) % 3;
    // Noise of numbers is not a colour.
    const double product = deviation[c] * deviation[d] + 1e-6 * shades[c] * shades[d];
    values.push_back(product > 0 ? float(m[3 * c + d] / product) : 0.0f);
  }
}

void append(std::vector<float>& values, const double* from, size_t count) {
  for (size_t i = 0; i < count; ++i) values.push_back(float(from[i]));
}

void append_quantiles(const Picture& picture, const Window& window, std::vector<float>& values) {
  constexpr int kQuantiles = 16;
  std::vector<std::pair<float, double>> shades(size_t(window.width) * size_t(window.height));
  for (size_t c = 0; c < 3; ++c) {
    auto out = shades.begin();
    for (int j = 0; j < window.height; ++j)
      for (int i = 0; i < window.width; ++i) *out++ = {picture.at(window.x + i, window.y + j)[c], window.weight(i, j)};
    std::sort(shades.begin(), shades.end());
    double below = 0;
    int q = 0;
    for (const auto& [shade, weight] : shades) {
      below += weight;
      while (q < kQuantiles && below >= (q + 0.5) / kQuantiles) values.push_back(shade), ++q;
    }
    for (; q < kQuantiles; ++q) values.push_back(shades.back().first);  // weights that add up to a little less than 1
  }
}

// Mean and root mean square of the sizes of differences to the next pixel across (step 1, 0) or down (0, 1), as
// contrast.
void append_edges(const Picture& picture, const Window& window, int step_x, int step_y, std::vector<float>& values) {
  double weights = 0, sizes[3] = {}, squares[3] = {};
  for (int j = 0; j + step_y < window.height; ++j)
    for (int i = 0; i + step_x < window.width; ++i) {
      const float* here = picture.at(window.x + i, window.y + j);
      const float* next = picture.at(window.x + i + step_x, window.y + j + step_y);
      const double weight = window.weight(i, j);
      weights += weight;
      for (int c = 0; c < 3; ++c) {
        const double difference = double(next[c]) - double(here[c]);
        sizes[c] += weight * std::abs(difference);
        squares[c] += weight * difference * difference;
      }
    }
  const std::array<double, 3> shades = shades_of(color_moments(picture, window).mean);
  for (size_t c = 0; c < 3; ++c) values.push_back(contrast(sizes[c] / weights, shades[c]));
  for (size_t c = 0; c < 3; ++c) values.push_back(contrast(std::sqrt(squares[c] / weights), shades[c]));
}

void append_differences(const Picture& picture, int step_x, int step_y, std::vector<float>& values) {
  for (int y = 0; y + step_y < picture.height; ++y)
    for (int x = 0; x + step_x < picture.width; ++x)
      for (int c = 0; c < 3; ++c) values.push_back(picture.at(x + step_x, y + step_y)[c] - picture.at(x, y)[c]);
}

}  // namespace

double unit_of(const std::vector<float>& values, double picture_brightness) {
  double squares = 0;
  for (const float value : values) squares += double(value) * double(value);
  const double mean = values.empty() ? 0 : squares / double(values.size());
  return std::max(std::sqrt(mean), kLeastUnit * picture_brightness);
}

Descriptor low_pass_descriptor(const DescriptorOptions& options) {
  return [options](const Picture& picture) {
    std::vector<Block> blocks;
    if (options.alignment == Alignment::aligned) {
      const std::vector<Picture> levels = levels_of(picture, options);
      for (size_t i = 0; i < levels.size(); ++i) blocks.push_back(pixels_block(level_name(i), levels[i].pixels, 1));
    } else {
      std::vector<float> values;
      const std::vector<Window> windows = windows_of(picture, options);
      for (const Window& window : windows) append(values, color_moments(picture, window).mean.data(), 3);
      blocks.push_back(windows_block("windows", std::move(values), windows.size()));
    }
    return finished(std::move(blocks), picture);
  };
}

Descriptor color_descriptor(const DescriptorOptions& options) {
  return [options](const Picture& picture) {
    std::vector<float> means, spread, quantiles;
    const std::vector<Window> windows = windows_of(picture, options);
    for (const Window& window : windows) {
      const ColorMoments moments = color_moments(picture, window);
      append(means, moments.mean.data(), 3);
      append_spread(moments, spread);
      append_quantiles(picture, window, quantiles);
    }
    return finished({windows_block("mean", std::move(means), windows.size()),
                     contrast_block("spread", std::move(spread), windows.size()),
                     windows_block("quantiles", std::move(quantiles), windows.size())},
                    picture);
  };
}

Descriptor gradient_descriptor(const DescriptorOptions& options) {
  return [options](const Picture& picture) {
    std::vector<Block> blocks;
    for (const Picture& level : levels_of(picture, options)) {
      std::vector<float> values;
      const std::string name = level_name(blocks.size());
      if (options.alignment == Alignment::aligned) {
        append_differences(level, 1, 0, values);
        append_differences(level, 0, 1, values);
        blocks.push_back(pixels_block(name, std::move(values), 2));
      } else {
        const std::vector<Window> windows = windows_of(level, options);
        for (const Window& window : windows) {
          append_edges(level, window, 1, 0, values);
          append_edges(level, window, 0, 1, values);
        }
        blocks.push_back(contrast_block(name, std::move(values), windows.size()));
      }
    }
    blocks = finished(std::move(blocks), picture);
    // One unit for all levels: a level that has hardly any edges of its own must not count by what aliases into it.
    double squares = 0;
    for (const Block& one : blocks) squares += one.weight * one.unit * one.unit;
    for (Block& one : blocks) one.unit = std::sqrt(squares);
    return blocks;
  };
}

Descriptor spectrum_descriptor(const DescriptorOptions& options) {
  return [options](const Picture& picture) {
    const int count = options.alignment == Alignment::aligned ? 1 : options.windows;
    std::vector<float> values;
    for (const Window& window : windows(picture.width, picture.height, count)) {
      const auto mean = color_moments(picture, window).mean;
      const double luminance = 0.2126 * mean[0] + 0.7152 * mean[1] + 0.0722 * mean[2];
      for (const double band : band_deviations(picture, window)) values.push_back(contrast(band, luminance));
    }
    return finished({contrast_block("bands", std::move(values), size_t(count * count))}, picture);
  };
}

}  // namespace wale::fit
