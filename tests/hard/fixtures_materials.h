#pragma once
// Materials at the ends of what a scene may say, in a white furnace.
#include "tests/image/picture.h"

namespace wale::test {

/// White cloth: roughness 0 and 90 degrees, index 1 and 4, optical radius 0, 1e-6 and 1e4, surface fibres at 89
/// degrees.
std::vector<Scene> white_plies_at_their_limits();

/// Cloth of colour 0 and 1e-6; balls of colour 0 and 1 under coats of roughness 0, 1e-4 and 1, index 1 and 4.
std::vector<Scene> dark_and_coated_at_their_limits();

}  // namespace wale::test
