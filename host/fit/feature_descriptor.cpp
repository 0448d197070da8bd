#include "host/fit/feature_descriptor.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/fit/windows.h"
#include "host/schema.h"

namespace wale::fit {
namespace {

Picture display(const Picture& picture, double exposure) {
  Picture out = picture;
  for (float& value : out.pixels) value = float(linear_to_srgb(std::clamp(double(value) * exposure, 0.0, 1.0)));
  return out;
}

// Appends half of the Gram matrix under a window.
void append_gram(const FeatureMap& map, const Window& window, std::vector<float>& values) {
  using Matrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Matrix part(map.channels, window.width * window.height);
  for (int c = 0; c < map.channels; ++c)
    for (int j = 0; j < window.height; ++j) {
      const float* row =
          &map.values[(size_t(c) * size_t(map.height) + size_t(window.y + j)) * size_t(map.width) + size_t(window.x)];
      for (int i = 0; i < window.width; ++i)
        part(c, j * window.width + i) = row[i] * float(std::sqrt(window.weight(i, j)));
    }
  Matrix gram(map.channels, map.channels);
  gram.noalias() = part * part.transpose();
  for (int a = 0; a < map.channels; ++a)
    for (int b = a; b < map.channels; ++b)
      values.push_back(gram(a, b) * (a == b ? 1.0f : std::numbers::sqrt2_v<float>));
}

}  // namespace

Descriptor feature_descriptor(std::shared_ptr<const FeatureNetwork> network, std::vector<LayerWeight> layers,
                              double exposure, const DescriptorOptions& options) {
  double sum = 0;
  std::vector<std::string> names;
  for (const LayerWeight& layer : layers) sum += layer.weight, names.push_back(layer.layer);
  return [=, network = std::move(network), layers = std::move(layers)](const Picture& picture) {
    std::vector<FeatureMap> maps = network->features(display(picture, exposure), names);
    Blocks blocks;
    for (size_t i = 0; i < maps.size(); ++i) {
      std::vector<float> values;
      const bool aligned = options.alignment == Alignment::aligned;
      const int passes = aligned ? maps[i].channels : 1, count = aligned ? 0 : options.windows * options.windows;
      if (aligned)
        values = std::move(maps[i].values);
      else
        for (const Window& window : windows(maps[i].width, maps[i].height, options.windows))
          append_gram(maps[i], window, values);
      // Display values have a brightness about 1 whatever the picture's.
      const double unit = unit_of(values, 0.0);
      blocks.push_back(
          {layers[i].layer, layers[i].weight / sum, unit > 0 ? unit : 1.0, std::move(values), passes, count});
    }
    return blocks;
  };
}

double display_exposure(const Picture& picture) {
  constexpr double kShare = 0.98, kShade = 0.8;
  std::vector<float> values = picture.pixels;
  if (values.empty()) return 1;
  const auto at = values.begin() + long(kShare * double(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at > 0 ? kShade / double(*at) : 1;
}

}  // namespace wale::fit
