#include <cmath>
#include <numbers>

#include "geom/flat_knit.h"

namespace wale {

// n circles of radius r with centres on a ring of radius h touch their neighbours when h sin(pi/n) = r, and fill the
// yarn of radius R when h + r = R.
void fill_yarn(YarnSpec& spec, double yarn_radius) {
  if (spec.plies == 1) {
    spec.ply_radius = yarn_radius;
    spec.helix_radius = 0;
    return;
  }
  const double s = std::sin(std::numbers::pi / spec.plies);
  spec.ply_radius = yarn_radius * s / (1 + s);
  spec.helix_radius = yarn_radius - spec.ply_radius;
}

}  // namespace wale
