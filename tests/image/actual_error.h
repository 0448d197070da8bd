#pragma once
#include <vector>

#include "host/image.h"

namespace wale::test {

/// Squared error of each tile of 8 x 8 pixels, against the truth: mean over its pixels of (difference in luminance /
/// max(true luminance, floor))^2, as tile_error() estimates it from the picture alone. `a` and `b` are two references
/// of the same scene, of other seeds than the picture's and than each other's: the product of the differences from one
/// and from the other is free of their own noise, on average. A single tile's may be below 0 by chance.
std::vector<double> actual_tile_errors(const Image& picture, const Image& a, const Image& b, double floor);

/// Root of their mean, and the root of the largest.
struct ActualError {
  double rms = 0, worst = 0;
};
ActualError summary(const std::vector<double>& squared);

}  // namespace wale::test
