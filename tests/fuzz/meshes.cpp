#include "tests/fuzz/meshes.h"

#include "tests/fuzz/expect.h"

namespace wale::fuzz {
void expect_consistent(const BaseMesh& mesh) {
  expect(!mesh.triangle.empty(), "no triangles");
  expect(mesh.uv.empty() || mesh.uv.size() == mesh.triangle.size(), "a triangle without UV");
  expect(mesh.normal.size() == mesh.position.size(), "a vertex without normal");
  for (const dvec3& p : mesh.position) expect(finite(p), "a vertex is not finite");
  for (const dvec3& n : mesh.normal) expect(std::abs(glm::length(n) - 1) < 1e-9, "a normal is not unit");
  for (const auto& t : mesh.triangle)
    for (const uint32_t v : t) expect(v < mesh.position.size(), "a corner names no vertex");
  for (const auto& t : mesh.uv)
    for (const dvec2& uv : t) expect(finite(uv), "a UV is not finite");
}

}  // namespace wale::fuzz
