#pragma once
#include <array>
#include <string>
#include <vector>

#include "host/image.h"

namespace wale::fit {

/// Scene-linear R, G, B of every pixel, row after row from the top.
struct Picture {
  int width = 0, height = 0;
  std::vector<float> pixels{};  ///< 3 * width * height

  Picture() = default;
  /// Black.
  Picture(int w, int h) : width(w), height(h), pixels(3 * size_t(w) * size_t(h)) {}
  size_t count() const { return size_t(width) * size_t(height); }
  float* at(int x, int y) { return pixels.data() + 3 * (size_t(y) * size_t(width) + size_t(x)); }
  const float* at(int x, int y) const { return pixels.data() + 3 * (size_t(y) * size_t(width) + size_t(x)); }
};

/// One cloth lit from the camera's side and from behind; both of one size.
struct PicturePair {
  Picture front, back;
};

/// Where an image has its colours: channels R, G and B, else its first three, else its first one three times.
std::array<size_t, 3> color_channels(const Image& image);

/// These colours. Throws a user
/// error "name: pixel ..." at the first value that is not finite.
Picture picture_of(const Image& image, const std::string& name);

/// Mean of all values; 0 where there are none.
double brightness(const Picture& picture);

}  // namespace wale::fit
