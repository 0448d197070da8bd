#include "geom/mesh_text_check.h"
#include "tests/fuzz/expect.h"
#include "tests/fuzz/targets.h"

// What stands before OpenMesh.
bool wale::fuzz::mesh_text(std::string_view bytes) {
  return accepted([&] { require_whole_ply(bytes, "fuzz.ply"); });
}
