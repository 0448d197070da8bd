#pragma once
#include "host/schema.h"

namespace wale {

/// The part of the scene's table that says what a material may hold.
Type material_type();
/// Image of a fabric that gives each stitch its colour.
Type color_image_type();

/// Groups of a ply material's keys of which at most one may be given.
const std::vector<KeyGroup>& ply_material_groups();

}  // namespace wale
