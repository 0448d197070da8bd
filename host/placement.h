#pragma once
#include <string>

#include "geom/fabric.h"
#include "shared/wale_types.h"

namespace wale {

/// Farthest coordinate of a mesh, metres: there a double still places a vertex to 1e-3 of a ply radius of 0.1 mm.
constexpr double kFarthestVertex = 1e9;

/// Largest rounding of a vertex in float, ply radii, at which cloth is still traced: beyond it plies are lumps.
constexpr double kCoarsestRounding = 0.125;

/// Throws a user error when the rays of a camera `distance` metres from the middle of what it sees round by more than a
/// pixel there.
void refuse_if_pixels_are_rounded(const WCamera& camera, double distance);

/// Throws a user error when a vertex that a triangle uses is not finite or lies beyond kFarthestVertex.
void refuse_if_out_of_reach(const BaseMesh& mesh, const std::string& name);

/// Throws a user error when floats about the scene's origin are too coarse for the fabric's thinnest curves.
void refuse_if_rounded(const Fabric& fabric, dvec3 origin);

}  // namespace wale
