#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host/fit/convolution.h"
#include "host/fit/feature_descriptor.h"

namespace wale::fit {

/// One of the 13 convolutions of VGG16 (K. Simonyan, A. Zisserman, "Very Deep Convolutional Networks for Large-Scale
/// Image Recognition", ICLR 2015, configuration D).
struct Vgg16Layer {
  int block, place;  ///< both from 1: conv<block>_<place>; a pool follows each block
  int in, out;       ///< channels
  int torch;         ///< its number in torchvision's "features"
  std::string name() const { return "conv" + std::to_string(block) + "_" + std::to_string(place); }
  std::string relu() const { return "relu" + std::to_string(block) + "_" + std::to_string(place); }
};
std::span<const Vgg16Layer> vgg16_layers();

/// What the weights were trained for.
enum class Normalisation {
  caffe,  ///< B, G, R from 0 to 255, less 103.939, 116.779, 123.68; the Oxford weights, and Keras'
  torch   ///< R, G, B from 0 to 1, less 0.485, 0.456, 0.406, over 0.229, 0.224, 0.225; torchvision's and ONNX models
};

/// The first convolutions of VGG16. Layers are named relu1_1, relu1_2, relu2_1, ...
class Vgg16 : public FeatureNetwork {
 public:
  /// One to thirteen of vgg16_layers(), of their shapes.
  Vgg16(std::vector<Convolution> convolutions, Normalisation normalisation);

  const std::vector<std::string>& layers() const override { return layers_; }
  /// Throws a user error when the picture is too small for a layer.
  std::vector<FeatureMap> features(const Picture& display, const std::vector<std::string>& layers) const override;
  /// "relu1_1 to relu2_2 of VGG16, 4 of 13 layers".
  std::string text() const;

 private:
  std::vector<Convolution> convolutions_;
  std::vector<std::string> layers_;
  Normalisation normalisation_;
};

/// Reads weights: a .npz of NumPy or an ONNX model, told apart by their first bytes; any number of layers from the
/// first on. `normalisation`: instead of what the layout says. Throws one-line user errors: no such file, neither
/// format, damaged, the first layer missing, a gap, a shape that is not VGG16's, numbers that are not finite.
std::shared_ptr<const Vgg16> read_vgg16(const std::filesystem::path& file,
                                        std::optional<Normalisation> normalisation = {});

/// From a .npz's bytes. Names block1_conv1_kernel and block1_conv1_bias with axes (row, column, in, out), as Keras has
/// them, mean Normalisation::caffe; conv1_1.weight or features.0.weight and .bias with (out, in, row, column), as
/// torchvision has them, Normalisation::torch. Other arrays are not read.
std::shared_ptr<const Vgg16> parse_vgg16_npz(std::string_view bytes, const std::string& file,
                                             std::optional<Normalisation> normalisation = {});

/// From an ONNX model's bytes: the weights of its Conv nodes in their order (onnx.proto of ONNX 1.15), kept in the file
/// itself as floats. Only Relu and MaxPool may stand between them.
std::shared_ptr<const Vgg16> parse_vgg16_onnx(std::string_view bytes, const std::string& file,
                                              std::optional<Normalisation> normalisation = {});

}  // namespace wale::fit
