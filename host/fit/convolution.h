#pragma once
#include <vector>

#include "host/fit/feature_descriptor.h"

namespace wale::fit {

/// A layer of 3 x 3 filters.
struct Convolution {
  int in = 0, out = 0;
  std::vector<float> weights;  ///< [out][in][row][column]
  std::vector<float> bias;     ///< [out]
};

/// Cross-correlation with the filters (what networks call a convolution), zeros beyond the border, bias, and nothing
/// below 0 (ReLU); same width and height. Strips of rows are written out as columns of a matrix (im2col), then one
/// product of matrices each; on several threads, with results that do not depend on their number.
FeatureMap convolved(const FeatureMap& map, const Convolution& layer);

/// Greatest of each 2 x 2 values; a last odd row or column is left out.
FeatureMap max_pooled(const FeatureMap& map);

}  // namespace wale::fit
