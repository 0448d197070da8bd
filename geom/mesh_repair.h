#pragma once
#include "geom/base_mesh.h"

namespace wale {

/// Makes one vertex of two that lie in exactly the same place, at both ends of two border edges that continue each
/// other: files that store every triangle, or every side of a UV seam, with vertices of its own. Layers of a folded or
/// doubled sheet stay apart. Returns the number of vertices joined; normals are recomputed when there are any.
size_t join_duplicate_vertices(BaseMesh& mesh);

/// Gives the sides of a seam vertices of their own where averaging their normals would cancel them: where two charts,
/// or the two ends of one (a Moebius strip), are wound against each other, and where more than two triangles share an
/// edge. Returns the number of vertices added; normals are recomputed when there are any.
size_t part_opposed_seams(BaseMesh& mesh);

}  // namespace wale
