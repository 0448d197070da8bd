#pragma once
#include <memory>
#include <string>
#include <vector>

#include "host/fit/descriptor.h"

namespace wale::fit {

/// What one layer of a network gives for a picture.
struct FeatureMap {
  int channels = 0, width = 0, height = 0;
  std::vector<float> values;  ///< channel after channel, rows from the top
};

/// A convolutional network by the names of its layers.
class FeatureNetwork {
 public:
  virtual ~FeatureNetwork() = default;
  /// Names of all layers that it can give, from the picture on.
  virtual const std::vector<std::string>& layers() const = 0;
  /// Maps of some of them, in this order, for display values (sRGB encoded, 0 to 1).
  virtual std::vector<FeatureMap> features(const Picture& display, const std::vector<std::string>& layers) const = 0;
};

/// A layer and its share of the descriptor.
struct LayerWeight {
  std::string layer;
  double weight = 1;
};

/// Layers of a network (as in L. Gatys, A. Ecker, M. Bethge, "Image Style Transfer Using Convolutional Neural
/// Networks", CVPR 2016). Aligned: the maps themselves. Unaligned: of each window the Gram matrix of its channels, sum
/// of weight times map times map; one half of it, with the square root of 2 off the diagonal, so that squares add up to
/// the Frobenius norm. The picture is multiplied by `exposure`, cut to 0..1 and sRGB encoded.
Descriptor feature_descriptor(std::shared_ptr<const FeatureNetwork> network, std::vector<LayerWeight> layers,
                              double exposure, const DescriptorOptions& options);

/// The factor that makes all but the brightest 2 % of a picture's values at most 0.8.
double display_exposure(const Picture& picture);

}  // namespace wale::fit
