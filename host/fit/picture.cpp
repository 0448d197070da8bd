#include "host/fit/picture.h"

#include <algorithm>
#include <cmath>

#include "geom/error.h"

namespace wale::fit {

std::array<size_t, 3> color_channels(const Image& image) {
  std::array<size_t, 3> rgb{};
  for (size_t c = 0; c < 3; ++c) {
    const auto found = std::find(image.channels.begin(), image.channels.end(), std::string(1, "RGB"[c]));
    // Grey with alpha is not a colour of two channels.
    const size_t other = image.channels.size() < 3 ? 0 : c;
    rgb[c] = found != image.channels.end() ? size_t(found - image.channels.begin()) : other;
  }
  return rgb;
}

Picture picture_of(const Image& image, const std::string& name) {
  if (image.width <= 0 || image.height <= 0 || image.channels.empty()) user_error("{}: an image without pixels", name);
  const auto rgb = color_channels(image);
  Picture picture(image.width, image.height);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (size_t c = 0; c < 3; ++c) {
        const float value = image.at(x, y)[rgb[c]];
        if (!std::isfinite(value))
          user_error("{}: pixel ({}, {}), channel {}: {} is not a finite number", name, x, y, image.channels[rgb[c]],
                     value);
        picture.at(x, y)[c] = value;
      }
  return picture;
}

double brightness(const Picture& picture) {
  double sum = 0;
  for (const float value : picture.pixels) sum += value;
  return picture.pixels.empty() ? 0 : sum / double(picture.pixels.size());
}

}  // namespace wale::fit
