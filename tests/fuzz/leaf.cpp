#include "tests/fuzz/patterns.h"
#include "tests/fuzz/targets.h"

bool wale::fuzz::leaf(std::string_view bytes) {
  static const std::filesystem::path file = "fuzz_0.1.txt";
  return read_tile(bytes, file, {});
}
