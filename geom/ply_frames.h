#pragma once
#include "geom/flat_knit.h"

namespace wale {

/// Fills in `normal` and `length` of a yarn whose ply positions are there; `plies` of them. Normals are carried along
/// each ply polyline by double reflection, perpendicular to the mean of the two unit edges at the vertex; they begin
/// pointing away from the yarn axis. On a closed yarn the closing angle is spread over the length, so that the ghost
/// samples agree with the samples that they repeat.
void frame_plies(FlatYarn& yarn, int plies);

/// Mean of the two unit edges at every vertex of a polyline of `count` points; the edge itself at its two ends.
void mean_tangents(const dvec3* points, size_t count, dvec3* tangent);

/// Mean of the two unit edges at sample k of a ply, to which its frame normal is perpendicular; the edge at an open
/// end.
dvec3 ply_tangent(const FlatYarn& yarn, size_t ply, size_t k);

}  // namespace wale
