// Pictures for screens.
#include "host/display_picture.h"

#include <algorithm>
#include <cmath>

#include "geom/error.h"
#include "host/image_coder.h"

namespace wale {
namespace {

// Fixed dither in [0,1): the finaliser of MurmurHash3 on the pixel, so that smooth shades show no bands and the same
// image gives the same bytes.
double dither(int x, int y, int channel) {
  uint32_t h = uint32_t(x) * 0x9E3779B1u ^ uint32_t(y) * 0x85EBCA77u ^ uint32_t(channel) * 0xC2B2AE3Du;
  h = (h ^ (h >> 16)) * 0x85EBCA6Bu;
  h = (h ^ (h >> 13)) * 0xC2B2AE35u;
  return (h ^ (h >> 16)) * 0x1p-32;
}

// The reason a coder gave, if any, is none of the user's.
void require_coded(const char* format, const std::string& failure) {
  if (!failure.empty()) bug("{}: {}", format, one_line(failure));
}

}  // namespace

std::vector<unsigned char> display_bytes(const Image& image, double exposure, const std::string& view) {
  int rgb[3] = {0, 0, 0};
  for (int c = 0; c < 3; ++c) {
    const auto found = std::find(image.channels.begin(), image.channels.end(), std::string(1, "RGB"[c]));
    rgb[c] = found != image.channels.end() ? int(found - image.channels.begin())
                                           : std::min(c, int(image.channels.size()) - 1);
  }
  std::vector<unsigned char> bytes(size_t(image.width) * image.height * 3);
  auto out = bytes.begin();
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const float* pixel = image.at(x, y);
      const float linear[3] = {pixel[rgb[0]], pixel[rgb[1]], pixel[rgb[2]]};
      float display[3];
      view_transform(linear, exposure, view, display);
      for (int c = 0; c < 3; ++c)
        *out++ = static_cast<unsigned char>(std::min(255.0, std::floor(255.0 * display[c] + dither(x, y, c))));
    }
  return bytes;
}

// In memory: OpenImageIO's writer does not notice a full disk.
std::string display_png(const Image& image, double exposure, const std::string& view) {
  std::string png;
  require_coded("PNG", image_coder().encode_png(display_bytes(image, exposure, view), image.width, image.height, png));
  return png;
}

std::string display_jpeg(const Image& image, double exposure, const std::string& view, int quality) {
  std::string jpeg;
  require_coded("JPEG", image_coder().encode_jpeg(display_bytes(image, exposure, view), image.width, image.height,
                                                  quality, jpeg));
  return jpeg;
}

}  // namespace wale
