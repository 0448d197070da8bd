#include "host/fit/vgg16.h"

#include <algorithm>
#include <cmath>

#include "geom/error.h"
#include "geom/text_lines.h"

namespace wale::fit {
namespace {

constexpr Vgg16Layer kLayers[] = {
    {1, 1, 3, 64, 0},     {1, 2, 64, 64, 2},    {2, 1, 64, 128, 5},   {2, 2, 128, 128, 7},  {3, 1, 128, 256, 10},
    {3, 2, 256, 256, 12}, {3, 3, 256, 256, 14}, {4, 1, 256, 512, 17}, {4, 2, 512, 512, 19}, {4, 3, 512, 512, 21},
    {5, 1, 512, 512, 24}, {5, 2, 512, 512, 26}, {5, 3, 512, 512, 28}};

FeatureMap normalised(const Picture& display, Normalisation normalisation) {
  constexpr float kCaffe[] = {103.939f, 116.779f, 123.68f};
  constexpr float kMean[] = {0.485f, 0.456f, 0.406f}, kDeviation[] = {0.229f, 0.224f, 0.225f};
  FeatureMap map{3, display.width, display.height, std::vector<float>(display.pixels.size())};
  const size_t count = display.count();
  for (size_t c = 0; c < 3; ++c)
    for (size_t i = 0; i < count; ++i)
      map.values[c * count + i] = normalisation == Normalisation::caffe
                                      ? 255 * display.pixels[3 * i + 2 - c] - kCaffe[c]
                                      : (display.pixels[3 * i + c] - kMean[c]) / kDeviation[c];
  return map;
}

}  // namespace

std::span<const Vgg16Layer> vgg16_layers() { return kLayers; }

Vgg16::Vgg16(std::vector<Convolution> convolutions, Normalisation normalisation)
    : convolutions_(std::move(convolutions)), normalisation_(normalisation) {
  if (convolutions_.empty() || convolutions_.size() > std::size(kLayers))
    bug("Vgg16: {} convolutions", convolutions_.size());
  for (size_t i = 0; i < convolutions_.size(); ++i) {
    const Convolution& c = convolutions_[i];
    const size_t weights = size_t(kLayers[i].in) * size_t(kLayers[i].out) * 9;
    if (c.in != kLayers[i].in || c.out != kLayers[i].out || c.weights.size() != weights ||
        c.bias.size() != size_t(c.out))
      bug("Vgg16: {} has not its shape", kLayers[i].name());
    layers_.push_back(kLayers[i].relu());
  }
}

std::string Vgg16::text() const {
  return fmt::format("{} to {} of VGG16, {} of {} layers", layers_.front(), layers_.back(), layers_.size(),
                     std::size(kLayers));
}

std::vector<FeatureMap> Vgg16::features(const Picture& display, const std::vector<std::string>& wanted) const {
  std::vector<FeatureMap> maps(wanted.size());
  size_t last = 0;
  for (const std::string& layer : wanted) {
    const auto found = std::find(layers_.begin(), layers_.end(), layer);
    if (found == layers_.end()) bug("Vgg16: no layer {}", layer);
    last = std::max(last, size_t(found - layers_.begin()));
  }
  if (wanted.empty()) return maps;
  FeatureMap map = normalised(display, normalisation_);
  for (size_t i = 0; i <= last; ++i) {
    if (i > 0 && kLayers[i].block != kLayers[i - 1].block) map = max_pooled(map);
    if (map.width == 0 || map.height == 0)
      user_error("{} x {} pixels are too few for {}; it needs {} x {}", display.width, display.height, layers_[i],
                 1 << (kLayers[i].block - 1), 1 << (kLayers[i].block - 1));
    map = convolved(map, convolutions_[i]);
    for (size_t j = 0; j < wanted.size(); ++j)
      if (wanted[j] == layers_[i]) maps[j] = map;
  }
  return maps;
}

std::shared_ptr<const Vgg16> read_vgg16(const std::filesystem::path& file, std::optional<Normalisation> normalisation) {
  std::error_code ignored;
  const std::string name = file.string();
  if (!std::filesystem::is_regular_file(file, ignored)) user_error("{}: no such file of weights", name);
  const std::string bytes = read_bytes(file);
  if (bytes.starts_with("PK")) return parse_vgg16_npz(bytes, name, normalisation);
  if (file.extension() == ".onnx") return parse_vgg16_onnx(bytes, name, normalisation);
  user_error("{}: weights are read from .npz files of NumPy and from .onnx models", name);
}

}  // namespace wale::fit
