#include "host/fit/npy.h"
#include "host/fit/vgg16.h"
#include "host/fit/zip_entries.h"
#include "tests/fuzz/expect.h"
#include "tests/fuzz/targets.h"

namespace wale::fuzz {
namespace {

void expect_network(const fit::Vgg16& network) {
  const auto& layers = network.layers();
  expect(!layers.empty() && layers.size() <= fit::vgg16_layers().size(), "not one to thirteen layers");
  const auto maps = network.features(fit::Picture(4, 4), {layers.front()});
  expect(maps.size() == 1 && maps[0].values.size() == 64u * 4 * 4, "features are missing");
}

}  // namespace

bool npy(std::string_view bytes) {
  return accepted([&] {
    const fit::NpyArray array = fit::parse_npy(bytes, "fuzz.npy");
    size_t count = 1;
    for (const size_t extent : array.shape) count *= extent;
    expect(count == array.values.size(), "numbers are missing");
  });
}

bool npz(std::string_view bytes) {
  return accepted([&] {
    for (const fit::ZipEntry& entry : fit::zip_entries(bytes, "fuzz.npz"))
      if (entry.size < (1 << 20))
        expect(fit::zip_content(bytes, entry, "fuzz.npz").size() == entry.size, "bytes are missing");
    expect_network(*fit::parse_vgg16_npz(bytes, "fuzz.npz"));
  });
}

// Weights are 7 KB, which damage would meet and the rest seldom: those of the first layer, "w" and "b", follow the
// bytes. Parts of one message in two places add up.
bool onnx(std::string_view bytes) {
  static const std::string weights = [] {
    const auto field = [](char number, const std::string& text) {
      std::string out(1, char(number << 3 | 2));
      size_t size = text.size();
      for (; size > 127; size >>= 7) out += char(128 | (size & 127));
      return out + char(size) + text;
    };
    const std::string type = "\x10\x01", shape = "\x08\x40\x08\x03\x08\x03\x08\x03";
    return field(7, field(5, shape + type + field(8, "w") + field(9, std::string(64 * 27 * 4, '\0'))) +
                        field(5, "\x08\x40" + type + field(8, "b") + field(9, std::string(64 * 4, '\0'))));
  }();
  const std::string model = std::string(bytes) + weights;
  return accepted([&] { expect_network(*fit::parse_vgg16_onnx(model, "fuzz.onnx")); });
}

}  // namespace wale::fuzz
