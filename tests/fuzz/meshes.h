#pragma once
#include "geom/base_mesh.h"

namespace wale::fuzz {

/// Positions and UV are finite, corners name vertices, normals are unit.
void expect_consistent(const BaseMesh& mesh);

}  // namespace wale::fuzz
