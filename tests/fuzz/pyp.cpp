#include "tests/fuzz/patterns.h"
#include "tests/fuzz/targets.h"

bool wale::fuzz::pyp(std::string_view bytes) {
  static const std::filesystem::path file = "fuzz.pyp";
  return read_tile(bytes, file, {});
}
