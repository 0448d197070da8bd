#pragma once
#include <string>
#include <vector>

#include "host/image.h"

namespace wale {

/// Three bytes a pixel through exposure and view transform, row 0 at the top; the same image gives the same bytes.
std::vector<unsigned char> display_bytes(const Image& image, double exposure, const std::string& view);

/// The same as a PNG file.
std::string display_png(const Image& image, double exposure, const std::string& view);

/// The same as a JPEG file of this quality, 1 to 100.
std::string display_jpeg(const Image& image, double exposure, const std::string& view, int quality);

}  // namespace wale
