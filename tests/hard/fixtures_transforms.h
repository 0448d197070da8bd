#pragma once
// One scene at any size, place and attitude, every coordinate transformed in double before the host sees it.
#include "tests/image/picture.h"

namespace wale::test {

/// p -> turn * (scale * p) + move.
struct Similarity {
  double scale = 1;
  dmat3 turn{1.0};
  dvec3 move{0, 0, 0};
  dvec3 point(const dvec3& p) const { return turn * (scale * p) + move; }
  dvec3 direction(const dvec3& d) const { return turn * d; }
};

constexpr double kSceneSize = 0.03;  ///< metres: the scene below, its lights and its camera, at scale 1

/// Rotation by `angle` radians about `axis`.
dmat3 rotation(dvec3 axis, double angle);

/// A square of cloth draped over a ball on a ground, lit by a quad, a ball and a grey sky, seen through a lens.
Scene draped_scene(const Similarity& at, int pixels);

/// The same with a second cloth, `distance` metres away from the first.
Scene two_cloths_apart(double distance);

/// The same through an angle of view of `fov` radians from so far away that the picture is nearly the same.
Scene seen_from_afar(double fov, int pixels);

}  // namespace wale::test
