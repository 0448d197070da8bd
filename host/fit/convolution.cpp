#include "host/fit/convolution.h"

#include <Eigen/Dense>
#include <algorithm>
#include <atomic>
#include <thread>

#include "geom/error.h"

namespace wale::fit {
namespace {

using Matrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr int kTaps = 9;
constexpr size_t kStripValues = 1 << 18;  // of the matrix of one strip: stays in the second cache

// Row (channel, tap), column (row of the strip, x): the value that the tap meets there.
void write_columns(const FeatureMap& map, int first, int rows, Matrix& columns) {
  const int width = map.width;
  for (int c = 0; c < map.channels; ++c)
    for (int tap = 0; tap < kTaps; ++tap) {
      const int up = tap / 3 - 1, aside = tap % 3 - 1;
      float* out = columns.data() + (size_t(c) * kTaps + size_t(tap)) * size_t(columns.cols());
      for (int j = 0; j < rows; ++j, out += width) {
        const int y = first + j + up;
        if (y < 0 || y >= map.height) {
          std::fill_n(out, width, 0.0f);
          continue;
        }
        const float* row = &map.values[(size_t(c) * size_t(map.height) + size_t(y)) * size_t(width)];
        const int begin = std::max(0, -aside), end = std::min(width, width - aside);
        std::fill_n(out, begin, 0.0f);
        if (begin < end) std::copy(row + begin + aside, row + end + aside, out + begin);
        std::fill(out + std::max(begin, end), out + width, 0.0f);
      }
    }
}

}  // namespace

FeatureMap convolved(const FeatureMap& map, const Convolution& layer) {
  if (map.channels != layer.in) bug("convolved: {} channels into {}", map.channels, layer.in);
  FeatureMap out{layer.out, map.width, map.height, {}};
  const size_t plane = size_t(map.width) * size_t(map.height);
  out.values.resize(size_t(layer.out) * plane);
  const Eigen::Map<const Matrix> weights(layer.weights.data(), layer.out, layer.in * kTaps);
  const Eigen::Map<const Eigen::VectorXf> bias(layer.bias.data(), layer.out);
  const size_t row_values = size_t(layer.in) * kTaps * size_t(map.width);
  const int rows = int(std::clamp<size_t>(kStripValues / std::max<size_t>(1, row_values), 1, size_t(map.height)));
  std::atomic<int> next{0};
  const auto work = [&] {
    Matrix columns, product;
    for (int first; (first = next.fetch_add(rows)) < map.height;) {
      const int count = std::min(rows, map.height - first);
      columns.resize(layer.in * kTaps, count * map.width);
      write_columns(map, first, count, columns);
      product.resize(layer.out, columns.cols());
      product.noalias() = weights * columns;
      product.colwise() += bias;
      product = product.cwiseMax(0.0f);
      for (int c = 0; c < layer.out; ++c)
        std::copy_n(product.data() + size_t(c) * size_t(product.cols()), product.cols(),
                    &out.values[size_t(c) * plane + size_t(first) * size_t(map.width)]);
    }
  };
  const int strips = (map.height + rows - 1) / rows;
  std::vector<std::jthread> others;
  for (int i = 1; i < std::min(strips, int(std::thread::hardware_concurrency())); ++i) others.emplace_back(work);
  work();
  others.clear();
  return out;
}

FeatureMap max_pooled(const FeatureMap& map) {
  FeatureMap out{map.channels, map.width / 2, map.height / 2, {}};
  out.values.reserve(size_t(out.channels) * size_t(out.width) * size_t(out.height));
  for (int c = 0; c < out.channels; ++c)
    for (int y = 0; y < out.height; ++y) {
      const float* above = &map.values[(size_t(c) * size_t(map.height) + 2 * size_t(y)) * size_t(map.width)];
      const float* below = above + map.width;
      for (int x = 0; x < out.width; ++x)
        out.values.push_back(std::max({above[2 * x], above[2 * x + 1], below[2 * x], below[2 * x + 1]}));
    }
  return out;
}

}  // namespace wale::fit
