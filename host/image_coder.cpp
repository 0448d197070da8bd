#include "host/image_coder.h"

#include "host/loaded_library.h"

namespace wale {

const ImageCoder& image_coder() {
  static const auto* coder = static_cast<const ImageCoder*>(load_table(kImageCoderLibrary, kImageCoderFunction));
  return *coder;
}

void require_image_coder() { require_library(kImageCoderLibrary); }

}  // namespace wale
