#include "tests/image/program.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "geom/error.h"

namespace wale::test {
std::string everything_scene(int size, double wales) {
  return fmt::format(R"({{
  "wale": 1,
  "units": "mm",
  "camera": {{"position": [10, -40, 45], "look_at": [0, 0, 3], "up": [0, 0, 1], "fov": 30}},
  "film": {{"size": [{0}, {0}]}},
  "materials": {{"yarn": {{"type": "ply", "preset": "wool", "color": [0.8, 0.5, 0.3]}},
                "floor": {{"type": "coated", "color": [0.4, 0.4, 0.5]}}}},
  "fabrics": [{{"name": "cloth", "mesh": {{"generator": "draped_square", "size": 30, "sphere_radius": 8, "nu": 16}},
               "pattern": {{"builtin": "stockinette"}}, "gauge": {{"wales": {1}}}, "yarn": {{"plies": 3}},
               "material": "yarn"}}],
  "objects": [{{"type": "ground", "up": [0, 0, 1], "height": -12, "extent": 18, "material": "floor"}}],
  "lights": [{{"type": "sphere", "position": [-30, -20, 40], "radius": 5, "radiance": 40}},
             {{"type": "environment", "radiance": [0.5, 0.6, 0.8], "up": [0, 0, 1]}}]
}})",
                     size, wales);
}

std::filesystem::path oclgrind() {
  const std::string name = "liboclgrind-rt-icd.so";
  for (const char* folder : {"/usr/lib/oclgrind", "/usr/local/lib/oclgrind", "/usr/local/lib", "/usr/lib"})
    if (std::filesystem::exists(std::filesystem::path(folder) / name)) return std::filesystem::path(folder) / name;
  return {};
}

size_t different_pixels(const Image& a, const Image& b) {
  const size_t pixels = size_t(a.width) * a.height, stride = a.channels.size();
  if (a.width != b.width || a.height != b.height || a.channels != b.channels) return std::max<size_t>(1, pixels);
  size_t differ = 0;
  for (size_t i = 0; i < pixels; ++i)
    differ += std::memcmp(a.pixels.data() + i * stride, b.pixels.data() + i * stride, stride * sizeof(float)) != 0;
  return differ;
}

Image means_and_variances(const std::filesystem::path& file) {
  const Image all = read_image(file);
  Image out{all.width, all.height, {"R", "G", "B", "variance.R", "variance.G", "variance.B"}, {}};
  for (int y = 0; y < all.height; ++y)
    for (int x = 0; x < all.width; ++x)
      for (const auto& name : out.channels) {
        const auto found = std::find(all.channels.begin(), all.channels.end(), name);
        if (found == all.channels.end()) bug("{}: no channel {}", file.string(), name);
        out.pixels.push_back(all.at(x, y)[found - all.channels.begin()]);
      }
  return out;
}

}  // namespace wale::test
