#include "host/image.h"

#include "tests/fuzz/expect.h"
#include "tests/fuzz/targets.h"

bool wale::fuzz::image(std::string_view bytes) {
  return accepted([&] {
    const Image image = parse_image(bytes, "fuzz.tga", true);  // a TGA has no first bytes of its own
    expect(image.width > 0 && image.height > 0 && !image.channels.empty(), "an image without pixels");
    expect(image.pixels.size() == size_t(image.width) * size_t(image.height) * image.channels.size(),
           "pixels are missing");
    for (const float value : image.pixels) expect(std::isfinite(value), "a pixel is not finite");
  });
}
