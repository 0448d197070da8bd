#pragma once
#include "host/fit/picture.h"

namespace wale::fit {

/// The picture in width x height pixels, each the mean of the area that it covers of the old ones, which count as
/// squares of one colour. The mean of the picture stays; sizes need not divide each other.
Picture at_resolution(const Picture& picture, int width, int height);

/// The picture and smaller ones, each half as wide and high (rounded up) as the one before, at most `levels` and down
/// to `smallest` pixels on the shorter side.
std::vector<Picture> pyramid(const Picture& picture, int levels, int smallest);

/// A rectangle of pixels: columns x to x + width - 1, rows y to y + height - 1.
struct Rectangle {
  int x = 0, y = 0, width = 0, height = 0;
};

/// The rectangle cut out; it lies within the picture.
Picture cropped(const Picture& picture, const Rectangle& part);

}  // namespace wale::fit
