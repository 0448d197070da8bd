#pragma once
#include <functional>
#include <string>
#include <string_view>

#include "host/image.h"

namespace wale {

/// What a file's header says of the image in it.
struct ImageHeader {
  int width = 0, height = 0;
  std::vector<std::string> channels;
  int alpha = -1;        ///< channel of it, -1: none
  bool deep = false;     ///< several samples a pixel
  bool srgb = false;     ///< integers that are sRGB encoded
  int integer_bits = 0;  ///< of one value; 0: floating point
};

/// What OpenImageIO does for Wale. All return what went wrong, in OpenImageIO's words, or an empty string.
struct ImageCoder {
  /// Image in the bytes of a file of OpenImageIO's `format`; `file` is its name. Colours as they are stored, integers
  /// as 0 to 1. Calls accept(header) before it makes room for the pixels; what that throws passes through.
  std::string (*decode)(std::string_view bytes, const std::string& format, const std::string& file,
                        const std::function<void(const ImageHeader&)>& accept, Image& image);
  /// PNG of 3 bytes a pixel, sRGB encoded.
  std::string (*encode_png)(const std::vector<unsigned char>& rgb, int width, int height, std::string& png);
  /// JPEG of the same, colours at full resolution; `quality` 1 to 100.
  std::string (*encode_jpeg)(const std::vector<unsigned char>& rgb, int width, int height, int quality,
                             std::string& jpeg);
  /// EXR of all channels.
  std::string (*write_exr)(const Image& image, const std::string& file);
};

/// Name of the library that holds it, and of the function in it that returns its address.
constexpr const char* kImageCoderLibrary = "libwale_image_coder.so";
constexpr const char* kImageCoderFunction = "wale_image_coder";

/// Loads the library at its first call: OpenImageIO brings some two hundred others, which takes 0.2 s that a render
/// needs only when its picture is done. Throws a user error when it is not beside the program or cannot be loaded.
const ImageCoder& image_coder();

/// Throws that error where the library is missing, and loads nothing.
void require_image_coder();

}  // namespace wale
