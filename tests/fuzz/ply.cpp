#include "tests/fuzz/expect.h"
#include "tests/fuzz/meshes.h"
#include "tests/fuzz/targets.h"

bool wale::fuzz::ply(std::string_view bytes) {
  return accepted([&] { expect_consistent(parse_mesh(bytes, "fuzz.ply")); });
}
