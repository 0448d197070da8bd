#pragma once
#include <vector>

#include "host/image.h"

namespace wale {

/// LDR-FLIP of two images of equal size (Andersson et al. 2020, "FLIP: A Difference Evaluator for Alternating Images"):
/// per pixel, 0 = looks the same, 1 = black against white. `a` and `b` hold linear RGB in [0,1], 3 values a pixel.
/// `pixels_per_degree` 67 is a 0.7 m wide 4K monitor seen from 0.7 m.
std::vector<float> flip_map(const std::vector<float>& a, const std::vector<float>& b, int width, int height,
                            double pixels_per_degree = 67.0206);

}  // namespace wale
