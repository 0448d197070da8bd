#pragma once
#include <array>
#include <string>

#include "host/image.h"

namespace wale {

/// How two images differ; over R, G and B of every pixel.
struct CompareReport {
  int width = 0, height = 0;
  double rmse = 0;          ///< root of the mean squared difference, linear
  double relative_mse = 0;  ///< mean of (a-b)^2 / (b^2 + epsilon), b the reference
  double flip_mean = 0;     ///< LDR-FLIP after sRGB encoding, clipped at 1; 0 to 1
  double largest = 0;       ///< largest absolute difference
  int largest_x = 0, largest_y = 0;
  std::string largest_channel;
  std::array<double, 3> mean_a{}, mean_b{};
  /// Several lines for a terminal.
  std::string text() const;
};

/// Compares the colour channels of two images (R, G, B by name, else the first ones). Throws a user error when the
/// sizes differ or a value is not finite; `name_a` and `name_b` are for that message.
CompareReport compare_images(const Image& a, const Image& b, const std::string& name_a = "first image",
                             const std::string& name_b = "second image", double epsilon = 1e-2);

}  // namespace wale
