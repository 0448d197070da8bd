// Weights of VGG16 in a .npz file: one .npy array for each layer's filters and bias.
#include <algorithm>
#include <cmath>

#include "geom/error.h"
#include "host/fit/npy.h"
#include "host/fit/vgg16.h"
#include "host/fit/zip_entries.h"

namespace wale::fit {
namespace {

class Arrays {
 public:
  Arrays(std::string_view bytes, const std::string& file)
      : bytes_(bytes), file_(file), entries_(zip_entries(bytes, file)) {}

  /// The entry of one of these names, ".npy" left out; null where there is none.
  const ZipEntry* find(const std::vector<std::string>& names) const {
    for (const ZipEntry& entry : entries_)
      if (std::any_of(names.begin(), names.end(), [&](const std::string& n) { return entry.name == n + ".npy"; }))
        return &entry;
    return nullptr;
  }
  NpyArray read(const ZipEntry& entry) const {
    const NpyArray array = parse_npy(zip_content(bytes_, entry, file_), file_ + ": " + entry.name);
    for (const float value : array.values)
      if (!std::isfinite(value)) user_error("{}: {}: {} is not a finite number", file_, entry.name, value);
    return array;
  }

 private:
  std::string_view bytes_;
  const std::string& file_;
  std::vector<ZipEntry> entries_;
};

std::vector<std::string> names_of(const Vgg16Layer& layer, const std::vector<std::string>& endings) {
  const std::string keras = fmt::format("block{}_conv{}", layer.block, layer.place);
  const std::string torch = fmt::format("features.{}", layer.torch);
  std::vector<std::string> names;
  for (const std::string& stem : {keras, layer.name(), torch})
    for (const std::string& ending : endings) names.push_back(stem + ending);
  return names;
}

// (row, column, in, out) to [out][in][row][column].
std::vector<float> from_keras(const std::vector<float>& values, size_t in, size_t out) {
  std::vector<float> weights(values.size());
  for (size_t tap = 0; tap < 9; ++tap)
    for (size_t i = 0; i < in; ++i)
      for (size_t o = 0; o < out; ++o) weights[(o * in + i) * 9 + tap] = values[(tap * in + i) * out + o];
  return weights;
}

}  // namespace

std::shared_ptr<const Vgg16> parse_vgg16_npz(std::string_view bytes, const std::string& file,
                                             std::optional<Normalisation> normalisation) {
  const Arrays arrays(bytes, file);
  std::vector<Convolution> convolutions;
  std::optional<bool> keras;  // the layout of all
  for (const Vgg16Layer& layer : vgg16_layers()) {
    const ZipEntry* kernel = arrays.find(names_of(layer, {"_kernel", "_weight", ".weight"}));
    if (convolutions.size() != size_t(&layer - vgg16_layers().data())) {
      if (kernel)
        user_error("{}: holds {} but no {}; layers must follow from the first without a gap", file, kernel->name,
                   vgg16_layers()[convolutions.size()].name());
      continue;
    }
    if (!kernel) continue;
    const ZipEntry* bias = arrays.find(names_of(layer, {"_bias", ".bias"}));
    if (!bias) user_error("{}: holds {} but no bias of {}", file, kernel->name, layer.name());
    NpyArray weights = arrays.read(*kernel);
    const size_t in = size_t(layer.in), out = size_t(layer.out);
    const bool as_keras = weights.shape == std::vector<size_t>{3, 3, in, out};
    if ((!as_keras && weights.shape != std::vector<size_t>{out, in, 3, 3}) || keras.value_or(as_keras) != as_keras)
      user_error("{}: {}: has {} numbers, not VGG16's 3 x 3 x {} x {} (Keras) or {} x {} x 3 x 3 (torch) as the first",
                 file, kernel->name, shape_text(weights.shape), in, out, out, in);
    keras = as_keras;
    NpyArray shift = arrays.read(*bias);
    if (shift.shape != std::vector<size_t>{out})
      user_error("{}: {}: has {} numbers, VGG16's {} has {}", file, bias->name, shape_text(shift.shape), layer.name(),
                 out);
    if (as_keras) weights.values = from_keras(weights.values, in, out);
    convolutions.push_back({layer.in, layer.out, std::move(weights.values), std::move(shift.values)});
  }
  if (convolutions.empty())
    user_error("{}: holds no first layer of VGG16: block1_conv1_kernel, conv1_1.weight or features.0.weight", file);
  return std::make_shared<Vgg16>(std::move(convolutions),
                                 normalisation.value_or(*keras ? Normalisation::caffe : Normalisation::torch));
}

}  // namespace wale::fit
