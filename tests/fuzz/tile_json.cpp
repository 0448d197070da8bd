#include "tests/fuzz/patterns.h"
#include "tests/fuzz/targets.h"

bool wale::fuzz::tile_json(std::string_view bytes) {
  static const std::filesystem::path file = "fuzz.json";
  return read_tile(bytes, file, {});
}
