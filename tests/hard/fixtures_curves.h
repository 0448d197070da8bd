#pragma once
// Plies whose shape breaks a careless intersector. Lengths in ply radii, so that a shape is the same trap at any scale.
#include <string>
#include <vector>

#include "geom/pattern.h"
#include "tests/kernels/synthetic.h"

namespace wale::test {

/// One run of plies that lie beside each other: as many points in each.
struct HardCurve {
  std::vector<std::vector<dvec3>> plies;  ///< points, in radii
};

HardCurve one_segment();               ///< a ply of a single segment: two caps and a side
HardCurve zero_length_segment();       ///< two equal points in the middle of a bend
HardCurve repeated_points();           ///< every point three times
HardCurve fold();                      ///< turns by exactly 180 degrees, twice, and comes back on itself
HardCurve spike();                     ///< turns by 170 degrees: a mitre there would be 11 radii long
HardCurve bend_tighter_than_radius();  ///< a U of curvature radius 0.5: segments shorter than their mitres
HardCurve loop_inside_itself();        ///< whole turns of curvature radius 0.7, rising by one diameter a turn
HardCurve nearly_too_tight();          ///< curvature radius 1.05: mitres just fit
HardCurve unequal_lengths();           ///< segments of 0.001, 0.1, 1 and 40 radii side by side, slightly bent
HardCurve open_ends();                 ///< several short plies end to end, their caps one in the other
HardCurve eight_plies();               ///< eight plies in one patch, twisted round a bent yarn
HardCurve overlapping_plies();         ///< three plies whose axes are half a radius apart
HardCurve straight(size_t segments, double length);  ///< along x, `length` each
HardCurve helix_curve();                             ///< gently bent, curvature radius 3.4

/// The same curve at another place and size: x -> scale * x + offset, radius = scale. Patches of full width.
Strands strands_of(const HardCurve& curve, double scale = 1, dvec3 offset = dvec3(0));

/// Positions as the device holds them, in double.
dvec3 vertex_of(const Strands& strands, size_t vertex);

/// Rays at points inside the plies, at most 0.95 radii off the axis, from `distance` radii away in all directions.
std::vector<Ray> aimed_rays(const Strands& strands, size_t count, double distance, uint32_t seed);

/// A tile that repeats the curve's first ply along x as yarn of radius `radius` metres; the curve's x range becomes the
/// period. The ply must end where it began but for x: ends are levelled.
Pattern tile_of(const HardCurve& curve, double radius);

}  // namespace wale::test
