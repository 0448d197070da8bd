#include "geom/polygon_soup.h"
#include "tests/fuzz/expect.h"
#include "tests/fuzz/meshes.h"
#include "tests/fuzz/targets.h"

bool wale::fuzz::off(std::string_view bytes) {
  return accepted([&] { expect_consistent(triangulate(parse_off(bytes, "fuzz.off"), "fuzz.off")); });
}
