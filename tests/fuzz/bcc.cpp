#include "tests/fuzz/patterns.h"
#include "tests/fuzz/targets.h"

// The format states neither: they come from the scene.
bool wale::fuzz::bcc(std::string_view bytes) {
  static const std::filesystem::path file = "fuzz.bcc";
  PatternHints hints;
  hints.period = {0.01, 0.01};
  hints.yarn_radius = 0.0005;
  return read_tile(bytes, file, hints);
}
