#pragma once
#include <array>
#include <vector>

#include "host/fit/picture.h"

namespace wale::fit {

/// A part of a picture that fades out towards its border, so that what crosses the border changes nothing by a jump.
struct Window {
  int x = 0, y = 0, width = 0, height = 0;
  std::vector<double> across, down;  ///< weights of its columns and rows; each adds up to 1
  double weight(int i, int j) const { return across[size_t(i)] * down[size_t(j)]; }
};

/// count x count windows, row by row, each overlapping its neighbours by half, squared-sine (Hann) weights. All are of
/// one size.
std::vector<Window> windows(int width, int height, int count);

/// Weights all equal over the whole picture.
Window whole_picture(int width, int height);

/// Moments of colours under a window's weights.
struct ColorMoments {
  std::array<double, 3> mean{};
  std::array<double, 9> covariance{};
};
ColorMoments color_moments(const Picture& picture, const Window& window);

/// Standard deviation of luminance (Rec. 709) by band of frequency, from high to low; the squares of all bands add up
/// to the variance under the squared weights. Band k begins at 2^(-1/2 - k/2) cycles a pixel and is half an octave
/// wide; the last one holds all that is slower than one cycle a window. How many there are follows from the window's
/// size.
std::vector<double> band_deviations(const Picture& picture, const Window& window);

}  // namespace wale::fit
