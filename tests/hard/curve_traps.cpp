#include <functional>

#include "tests/hard/curve_look.h"
#include "tests/image/picture.h"
#include "tests/tolerances.h"

namespace wale::test {
namespace {

constexpr const char* kSamePlace = "every hit lies on the ply's true surface and on its ray, and no ray slips through";

Trap shape(std::string name, std::string breaks, HardCurve (*curve)()) {
  return {std::move(name), std::move(breaks), kSamePlace, "ply radii", tolerance::kPointFloat, 0, [curve] {
            return look_at_curve(strands_of(curve()), 11);
          }};
}

/// Helix and fold with plies of this radius in metres.
Finding of_size(double radius) {
  Finding f;
  for (const Strands& s : {strands_of(helix_curve(), radius), strands_of(fold(), radius)})
    f = worse(f, look_at_curve(s, 17));
  return f;
}

Trap size(std::string name, double radius) {
  return {std::move(name),
          "products of three lengths leave the range of a float: 0, denormal or infinite",
          kSamePlace,
          "ply radii",
          tolerance::kPointFloat,
          0,
          [radius] { return of_size(radius); }};
}

/// From the middle of a yarn of three plies, along and across it: every ray starts between plies or in one.
Finding camera_inside() {
  const double r = 1e-3;
  Scene scene = empty_scene(r, 24);
  scene.camera.position = dvec3(0, r, 0);  // the axis of a row; the film covers the yarn's upper half
  scene.camera.look_at = dvec3(0, r, -1);
  add_fabric(scene, tile_of(straight(3, 4), r), 0.05, 0.05, 3, "wool", Rgb{1, 1, 1});
  scene.lights.push_back(constant_environment(1));
  return look_at_furnace(scene, 256);
}

/// A tile in a white furnace, seen by 24 x 24 pixels over two of its periods.
Finding furnace_of(const Pattern& tile, int plies) {
  constexpr int kSpp = 256;
  const double size = 2 * std::max(tile.period.x, tile.period.y);
  Scene scene = empty_scene(size, 24);
  add_fabric(scene, tile, 2 * size, 2 * size, plies, "wool", Rgb{1, 1, 1});
  scene.lights.push_back(constant_environment(1));
  return look_at_furnace(scene, kSpp);
}

Trap tile(std::string name, std::string breaks, const std::function<Pattern()>& pattern, int plies) {
  return {std::move(name),
          std::move(breaks),
          "in a white furnace every pixel is 1 within its noise; no sample is lost or not finite",
          "of the picture's mean",
          tolerance::kFurnaceMean,
          0,
          [pattern, plies] { return furnace_of(pattern(), plies); }};
}

Finding far_place(double radii) {
  // The offset is no round number, so that every coordinate is rounded to the spacing of floats there.
  const dvec3 offset = radii * dvec3(0.71, -0.53, 0.37);
  Finding f;
  for (const Strands& s : {strands_of(helix_curve(), 1, offset), strands_of(eight_plies(), 1, offset)})
    f = worse(f, look_at_curve(s, 5));
  return f;
}

Trap far(std::string name, double radii) {
  return {std::move(name),
          "a world coordinate there is rounded to a good part of a ply, and a hit computed in it jumps off the surface",
          "the ply that the rounded vertices describe is met as exactly as one at the origin",
          "ply radii",
          tolerance::kPointFloat,
          0,
          [radii] { return far_place(radii); }};
}

}  // namespace

std::vector<Trap> curve_traps() {
  const double r = 4e-4;
  return {
      shape("ply of one segment", "both ends of the only segment are caps: a mitre with no neighbour divides by zero",
            one_segment),
      shape("zero-length segment", "its axis has no direction, and the bisector planes beside it are NaN",
            zero_length_segment),
      shape("repeated points", "two of three segments are points, with no direction for their neighbours' mitres",
            repeated_points),
      shape("fold by 180 degrees", "the two unit edges cancel and the bisector plane has no normal", fold),
      shape("spike of 170 degrees", "the mitre's ellipse is 11 radii long and sticks out of every bounding box", spike),
      shape("bend tighter than the radius", "the mitres at both ends of a segment cross and cut it away",
            bend_tighter_than_radius),
      shape("radius larger than the curvature radius",
            "the inner side of every mitre lies beyond the centre of the bend", loop_inside_itself),
      shape("bend that just holds its mitres", "segments shrink to nothing on the inner side: a sliver decides",
            nearly_too_tight),
      shape("segments of 0.001 and of 40 radii side by side",
            "a plane through the neighbours' points instead of the true bisector opens a crack", unequal_lengths),
      shape("open ends inside one another", "a cut end shows the hollow inside, or a cap counts twice", open_ends),
      shape("eight plies in one patch", "lanes of the leaf mix up their neighbours", eight_plies),
      shape("plies that overlap", "an entry inside another ply ends a path that has long been inside",
            overlapping_plies),
      far("ply 1e3 radii from the origin", 1e3),
      far("ply 1e5 radii from the origin", 1e5),
      far("ply 1e7 radii from the origin", 1e7),
      size("ply of 1e-10 m radius", 1e-10),
      size("ply of 1e9 m radius", 1e9),
      {"camera inside a ply", "the first ray starts behind the surface that it should enter",
       "in a white furnace every pixel is 1 within its noise; no sample is lost or not finite", "of the picture's mean",
       tolerance::kFurnaceMean, 0, camera_inside},
      tile(
          "tile that bends tighter than its yarn", "plies on the inside of the bend run backwards",
          [r] {
            return tile_of(HardCurve{{{{0, 0, 0}, {0.4, 2, 0}, {0.8, 0, 0.2}, {1.2, 2, 0}, {1.6, 0, 0}}}}, r);
          },
          3),
      tile(
          "tile of one segment", "nothing bends, and both ends join the neighbouring tiles",
          [r] { return tile_of(straight(1, 8), r); }, 1),
      tile(
          "tile with repeated points", "the spline's parameter does not move where points repeat",
          [r] { return tile_of(repeated_points(), r); }, 3),
      tile(
          "tile that folds back", "the plies' frames turn by half a turn at one vertex",
          [r] { return tile_of(fold(), r); }, 3),
      tile(
          "tile with a spike", "the twist of the plies runs through a turn of 170 degrees",
          [r] {
            return tile_of(HardCurve{{{{0, 0, 0}, {6, 1, 0}, {2, 2, 0.5}, {9, 1, 0}, {12, 0, 0}}}}, r);
          },
          3),
      tile(
          "tile of eight plies", "the most plies that a leaf holds", [r] { return tile_of(straight(3, 4), r); }, 8),
      tile(
          "tile whose rows overlap", "every ray enters several plies before it leaves one",
          [r] {
            Pattern p = tile_of(straight(3, 4), r);
            p.period.y = 0.7 * r;
            return p;
          },
          2),
  };
}

}  // namespace wale::test
