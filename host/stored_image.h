#pragma once
#include <filesystem>
#include <string_view>

#include "host/image.h"

namespace wale {

/// An image with its values as its file stores them: integers as 0 to 1, colours not decoded.
struct StoredImage {
  Image image;
  int alpha = -1;        ///< channel of it, -1: none
  bool srgb = false;     ///< integers that are sRGB encoded, as far as the file says
  int integer_bits = 0;  ///< of one value; 0: floating point
};

/// As read_image() and parse_image().
StoredImage read_stored_image(const std::filesystem::path& file);
StoredImage parse_stored_image(std::string_view bytes, const std::filesystem::path& file);

/// Makes every channel but alpha linear, in place (IEC 61966-2-1).
void decode_srgb(StoredImage& stored);

}  // namespace wale
