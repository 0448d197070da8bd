#pragma once
#include <array>
#include <span>
#include <vector>

#include "host/image.h"
#include "shared/wale_types.h"

namespace wale {

/// Independent scrambles of the samples (W_SCRAMBLES of sampling/sobol.clh), summed apart.
constexpr size_t kScrambles = 8;

/// What the wavefront gathered, as sums.
struct FilmSums {
  int width = 0, height = 0;
  std::vector<w_float4> radiance;  ///< width*height*8: per scramble rgb and count
  std::vector<w_float4> aov;       ///< width*height*4, or empty: albedo+depth, normal+u, tangent+v, position
  std::vector<uint32_t> ply;       ///< width*height, or empty: ply seen by the first sample
};

/// What a pixel's scrambles say of one quantity: weights . rgb.
struct PixelStatistics {
  double samples = 0, mean = 0;
  double variance = 0;  ///< of the mean; 0 where fewer than two scrambles hold samples
  int scrambles = 0;    ///< that hold samples
};
PixelStatistics pixel_statistics(std::span<const w_float4> scrambles, const std::array<double, 3>& weights);

/// Pixel means, the variance of each mean (from the spread of the scrambles that hold samples), sample counts and,
/// where gathered, the first-hit features. `origin` is added back to positions. Channels: R G B, variance.R/G/B,
/// samples, albedo.R/G/B, depth.Z, normal.X/Y/Z, tangent.X/Y/Z, position.X/Y/Z, uv.U/V, ply.id (-1 where no ply was
/// seen first).
Image develop(const FilmSums& sums, const double origin[3]);

/// The same where derivatives were gathered: R G B, variance.R/G/B, samples, then per channel those by the parameters
/// of kernels/appearance/ply_gradient.clh: by.transmit.R/G/B, by.reflect, by.roughness (radian), by.tilt (tangent).
Image develop_gradients(const FilmSums& sums);
constexpr std::array<const char*, W_GRADIENT_COUNT> kGradientNames = {"by.transmit", "by.reflect", "by.roughness",
                                                                      "by.tilt"};

}  // namespace wale
