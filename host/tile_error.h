#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "host/film_device.h"

namespace wale {

/// Noise of a tile of 8 x 8 pixels: root mean square over its pixels of (standard error of the mean) / (mean), in
/// Rec. 709 luminance. Luminance, because noise is seen in it, and because a channel that a colour hardly has would
/// otherwise decide for the picture. The standard error of a pixel comes from its scrambles, which are independent of
/// each other: 7 degrees of freedom a pixel, 448 a tile, so that the error of a tile is itself known to 3 %.
///
/// `floor` is the least mean luminance that an error is compared with: what is darker is judged by its absolute noise.
/// Pixels without samples (those outside of the picture) are left out; infinite when there are no others, or where one
/// has samples of one scramble alone, which say nothing of its noise. `sums`: kScrambles a pixel, as PixelSums.
double tile_error(std::span<const w_float4> sums, double floor);

/// Mean luminance of the pixels that have samples; 0 when none has.
double tile_luminance(std::span<const w_float4> sums);

/// The floor of a picture from the luminances of its tiles: a twentieth of their mean, the brightest twentieth of the
/// tiles left out, in which a light may be seen. Under E = 0.05 noise of what is darker stays below 1/400 of that mean,
/// less than a step of 8 bits on most displays.
double error_floor(std::vector<double> luminances);

/// What a picture's samples amount to.
struct Reached {
  double floor = 0;                       ///< luminance that errors were compared with at least
  double worst = 0, p95 = 0, median = 0;  ///< of the tiles' errors
  uint32_t tiles = 0, missed = 0;         ///< tiles; those whose error is above the goal, 0 without one
  uint32_t least = 0, most = 0;           ///< samples per pixel
  double mean = 0;
};

/// From each tile's error and its samples per pixel. `goal`: 0 when there is none.
Reached reached(std::vector<double> errors, const std::vector<uint32_t>& samples, double goal, double floor);

}  // namespace wale
