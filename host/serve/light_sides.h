#pragma once
#include <string>
#include <vector>

#include "host/serve/edited_scene.h"

namespace wale {

enum class LitSide { front, back };

/// Overrides that bring every quad and sphere light to one side of what is looked at: those on the other side are
/// mirrored at the plane through the middle of the picture that the camera sees face on. Under light from behind the
/// grounds of the scene, which would keep it off, are left out. Nothing where the scene has no camera of its own.
std::vector<std::string> light_sides(const EditedScene& scene, const CameraScene& camera, LitSide side);

}  // namespace wale
