#include "host/placement.h"

#include <algorithm>
#include <cmath>

#include "geom/error.h"

namespace wale {

void refuse_if_out_of_reach(const BaseMesh& mesh, const std::string& name) {
  for (const auto& t : mesh.triangle)
    for (const uint32_t v : t)
      for (int axis = 0; axis < 3; ++axis)
        if (!(std::abs(mesh.position[v][axis]) <= kFarthestVertex))
          user_error("\"{}\": vertex {} lies at {:.3g} m after its transform; at most {:.0e} m from 0 can be placed",
                     name, v + 1, mesh.position[v][axis], kFarthestVertex);
}

void refuse_if_pixels_are_rounded(const WCamera& camera, double distance) {
  const bool orthographic = camera.kind == 1;
  const double pixel = 2.0 * camera.half_height / camera.height * (orthographic ? 1.0 : distance);
  const double rounding = std::ldexp(distance, -24);
  if (!(rounding <= pixel))
    user_error(
        "camera: it stands {:.3g} m from the middle of the scene, where floats round by {:.2g} m and its pixels are "
        "{:.2g} m wide; {}, or give fewer pixels",
        distance, rounding, pixel, orthographic ? "move it closer" : "widen its angle of view");
}

void refuse_if_rounded(const Fabric& fabric, dvec3 origin) {
  double thinnest = INFINITY, farthest = 0, highest = 0;
  for (const PlyRun& run : fabric.runs) {
    if (!std::isfinite(run.radius))
      user_error("fabric \"{}\": its plies have a radius of {} m, which no float holds; check the tile's yarn_radius",
                 fabric.name, run.radius);
    thinnest = std::min(thinnest, double(run.radius));
  }
  if (!fabric.lattice.empty()) thinnest = fabric.ply_radius;
  for (const LatticeChart& chart : fabric.lattice) highest = std::max(highest, chart.tile.highest);
  for (const Anchor& anchor : fabric.anchors) highest = std::max(highest, std::abs(double(anchor.height)));
  for (const auto& t : fabric.mesh.triangle)
    for (const uint32_t v : t)
      for (int axis = 0; axis < 3; ++axis)
        farthest = std::max(farthest, std::abs(fabric.mesh.position[v][axis] - origin[axis]));
  farthest += highest;
  const double rounding = std::ldexp(farthest, -24);  // half the distance of neighbouring floats, at most
  if (rounding > kCoarsestRounding * thinnest)
    user_error(
        "fabric \"{}\": it reaches {:.3g} m from the middle of the scene's fabrics, where floats round by {:.2g} of "
        "its thinnest radius, {:.3g} m; bring the fabrics to within {:.3g} m of their middle, or render them apart",
        fabric.name, farthest, rounding / thinnest, thinnest, std::ldexp(kCoarsestRounding * thinnest, 24));
}

}  // namespace wale
