#pragma once
// Holes of a cloth, counted in pictures: pixels that see through it, by their distance from the cloth's own borders.
#include "host/world.h"

namespace wale::test {

/// Rays of pictures, sorted by where they enter the base mesh.
struct HoleCount {
  size_t rays[2] = {0, 0}, passed[2] = {0, 0};  ///< [0] in the middle of the cloth, [1] at seams and borders
  size_t stray = 0;                             ///< hits far outside of where cloth may be: frayed or loose ends
  double rate(int where) const { return rays[where] ? double(passed[where]) / double(rays[where]) : 0; }
};

/// Looks at fabric 0 of a world from `direction` (towards the cloth) on to a square film of `height` metres about
/// `target`, one sample a pixel, and adds to `count`. A ray passes when it enters the base mesh, by 60 degrees or less
/// from the normal, and meets no ply down to 1.5 times the cloth's own half thickness below it. `Border` is what lies
/// within a stitch of a chart's border in UV, `middle` what lies beyond two.
void count_holes(const World& world, const BaseMesh& mesh, dvec3 target, dvec3 direction, double height, int pixels,
                 HoleCount& count);

}  // namespace wale::test
