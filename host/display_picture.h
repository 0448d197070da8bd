#pragma once
#include <string>

#include "host/image.h"

namespace wale {

/// display_bytes() (host/image.h) as a PNG file.
std::string display_png(const Image& image, double exposure, const std::string& view);

/// The same as a JPEG file of this quality, 1 to 100.
std::string display_jpeg(const Image& image, double exposure, const std::string& view, int quality);

}  // namespace wale
