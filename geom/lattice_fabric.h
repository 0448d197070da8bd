#pragma once
#include <string>

#include "geom/fabric.h"

namespace wale {

/// Why this fabric cannot be held as a lattice; empty when it can: whole tiles over rectangular charts, plies of one
/// colour without explicit fibres or flyaways, affine strain, and a tile that joins its own copies.
std::string lattice_obstacle(const BaseMesh& mesh, const Pattern& pattern, const FabricSpec& spec);

/// Knits the fabric as lattice and tile (Fabric::lattice): spec.lattice cells along a tile's side, 1 where it is 0. The
/// tiles are stretched by less than half a tile over the chart, so that whole ones cover it; yarns end at its borders.
/// Throws the user errors of knit_fabric, and one that names the obstacle.
Fabric knit_lattice(BaseMesh mesh, const Pattern& pattern, const FabricSpec& spec);

}  // namespace wale
