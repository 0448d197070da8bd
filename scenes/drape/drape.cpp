// Frames of a square of heavy cloth that falls onto a ball: OUT.obj, the mesh at rest with UV in metres, and OUT.pc2,
// its positions frame by frame, for scenes/drape.json.
#include <fmt/format.h>

#include <charconv>
#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>

#include "geom/error.h"
#include "scenes/drape/cloth.h"
#include "scenes/drape/point_cache.h"

namespace {

constexpr const char* kUsage = "usage: drape OUT [FRAMES [CELLS]]";

int number(const char* text, int least, int most, const char* name) {
  const std::string_view all = text;
  int value = 0;
  const auto [end, error] = std::from_chars(all.data(), all.data() + all.size(), value);
  if (error != std::errc() || end != all.data() + all.size() || value < least || value > most)
    wale::user_error("drape: {} \"{}\": valid: {} to {}", name, text, least, most);
  return value;
}

int run(int argc, char** argv) {
  if (argc < 2 || argc > 4) wale::user_error("{}", kUsage);
  const std::filesystem::path out = argv[1];
  const int frames = argc > 2 ? number(argv[2], 1, 10000, "FRAMES") : 48;
  wale::drape::Setup setup;
  if (argc > 3) setup.cells = number(argv[3], 4, 1000, "CELLS");
  wale::drape::Cloth cloth(setup);
  wale::write_obj(cloth.rest(), out.string() + ".obj");
  wale::drape::PointCache cache(out.string() + ".pc2", uint32_t(cloth.positions().size()), uint32_t(frames));
  for (int frame = 0; frame < frames; ++frame) {
    if (frame) cloth.advance();
    cache.add(cloth.positions());
  }
  cache.finish();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const wale::Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return int(error.fault());
  }
}
