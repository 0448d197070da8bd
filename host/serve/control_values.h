#pragma once
#include <string>
#include <vector>

#include "host/scene.h"

namespace wale {

/// "#rrggbb", sRGB, of a scene-linear colour.
std::string hex_color(const Rgb& linear);

/// A number as overrides have it: seven digits.
std::string plain_number(double value);

/// "[x, y, z]" in the file's units.
std::string point_text(const dvec3& metres, double metres_per_unit);

/// What a thick layer of this yarn shows in diffuse light.
Rgb shown_color(const PlyAppearance& yarn);

/// Where a light stands as seen from what it shines at: degrees around `up` (0 = towards +z, or towards -y where z is
/// up; positive to the right as seen from there) and above the level.
struct LightAngles {
  double around = 0, above = 0;
};
LightAngles light_angles(const dvec3& from_target, const dvec3& up);
/// The unit vector in that direction.
dvec3 light_direction(const LightAngles& angles, const dvec3& up);

}  // namespace wale
