#include "geom/mesh_text_check.h"
#include "tests/fuzz/expect.h"
#include "tests/fuzz/targets.h"

// What stands before OpenMesh: the first byte chooses the format.
bool wale::fuzz::mesh_text(std::string_view bytes) {
  if (bytes.empty()) return false;
  const auto check = bytes[0] == 'p' ? require_whole_ply : require_whole_off;
  return accepted([&] { check(bytes.substr(1), "fuzz.mesh"); });
}
