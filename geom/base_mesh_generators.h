#pragma once
#include "geom/base_mesh.h"

namespace wale {

/// Bundled base meshes. Lengths in metres; UVs are metres along the cloth except where said.
/// swatch: flat, in the plane z = 0, `width` x `height`, centred, u along x, v along y.
BaseMesh make_swatch(double width, double height, int nu, int nv);
/// tube: axis z, from z = 0 to `height`; u = angle * radius in [0, 2 pi radius], seam at angle 0; v along the axis.
BaseMesh make_tube(double radius, double height, int nu, int nv);
/// pillow: two swatches sewn at their borders and inflated to `thickness`; two charts.
BaseMesh make_pillow(double width, double height, double thickness, int nu, int nv);
/// beanie: a ribbed-brim shape of revolution (tube chart, joined at its seam) with a crown cap (disc chart).
BaseMesh make_beanie(double radius, double height, int nu, int nv);
/// sock: the leg hangs from z = `height` down to a round heel, the foot of `length` lies along x and ends in a capped
/// toe; the sole's lowest line is a little below z = 0. Tube chart, joined at its seam along the heel and sole, and the
/// cap's disc chart.
BaseMesh make_sock(double radius, double height, double length, int nu, int nv);
/// draped square: a square of cloth over a sphere of `sphere_radius` at the origin, closed form, no simulation.
BaseMesh make_draped_square(double size, double sphere_radius, int n);

}  // namespace wale
