#pragma once
#include <array>
#include <string>

#include "geom/vec.h"
#include "host/fit/picture.h"

namespace wale::fit {

/// Where the corners of a rectangle lie in a photograph: top left, top right, bottom right, bottom left, in pixels.
/// Pixel (i, j) covers [i, i+1] x [j, j+1], so that the centre of the first one is (0.5, 0.5).
using Corners = std::array<dvec2, 4>;

/// The projective map of the unit square onto a convex quadrilateral, (0,0), (1,0), (1,1), (0,1) onto its corners in
/// this order. Closed form of P. S. Heckbert, "Fundamentals of Texture Mapping and Image Warping" (1989),
/// section 2.2.3.
class Homography {
 public:
  explicit Homography(const Corners& corners);
  dvec2 operator()(dvec2 p) const;

 private:
  double a_, b_, c_, d_, e_, f_, g_, h_;  ///< ((a u + b v + c) / w, (d u + e v + f) / w), w = g u + h v + 1
};

/// What is wrong with corners in a photograph of width x height pixels, or an empty string: they must lie in it, turn
/// clockwise as seen, be convex, and no side may be shorter than a pixel.
std::string corners_fault(const Corners& corners, int width, int height);

/// Width and height in pixels that keep about the photograph's own resolution: the longer ones of opposite sides.
ivec2 size_of(const Corners& corners);

/// True where a point lies within the quadrilateral or on its border.
bool inside(const Corners& corners, dvec2 p);

/// The rectangle seen straight on, in width x height pixels. Each is the mean of the photograph's pixels, as squares of
/// one colour, over the quadrilateral that it comes from, by exact areas: nothing of the rectangle is skipped or
/// counted twice, whatever the ratio of sizes.
Picture rectified(const Picture& photograph, const Corners& corners, int width, int height);

}  // namespace wale::fit
