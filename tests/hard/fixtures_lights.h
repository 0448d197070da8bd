#pragma once
// Scenes whose lights, cameras or materials are traps. Each says what its picture is in closed form.
#include "tests/image/picture.h"

namespace wale::test {

/// A picture that is one radiance everywhere.
struct ConstantPicture {
  Scene scene;
  double radiance = 1;
};

/// Grey ground under a sphere light of radius 1e-9 m at 1e4 m: a share of 1e-26 of the hemisphere.
ConstantPicture ground_under_a_speck();
/// Grey ground under a sphere light of radius 5e5 m at 1e6 m.
ConstantPicture ground_under_a_far_giant();
/// Grey ground in the plane of a quad light: cosines are 0.
ConstantPicture ground_beside_a_quad_in_its_plane();
/// White cloth and camera inside a sphere light.
ConstantPicture cloth_inside_a_light();
/// White cloth whose corners reach through the sphere light that holds it and the camera.
ConstantPicture cloth_through_a_light();
/// White cloth in a white furnace, seen from behind, its top touched by a quad light of the same radiance.
ConstantPicture cloth_touched_by_a_light();
/// White cloth in a white furnace from a camera in the middle of a ply.
ConstantPicture camera_inside_a_ply();
/// White cloth in a white furnace seen exactly along its plane.
ConstantPicture camera_along_the_cloth();
/// White cloth in a furnace of that radiance.
ConstantPicture furnace_of(double radiance);
/// White cloth in a white furnace through that vertical angle of view, radians.
ConstantPicture furnace_through(double fov);
/// White cloth in a white furnace on a film of one pixel.
ConstantPicture furnace_on_one_pixel();
/// Two equal white cloths in one place, in a white furnace.
ConstantPicture two_cloths_in_one_place();
/// Two white grounds in one place, in a white furnace.
ConstantPicture two_grounds_in_one_place();
/// Grey ground under a sky one pixel of which is 1e6 times as bright as the rest.
ConstantPicture ground_under_a_hot_pixel();
/// White cloth under the same sky; no closed form.
Scene cloth_under_a_hot_pixel();

}  // namespace wale::test
