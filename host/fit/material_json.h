#pragma once
#include <string>

#include "host/fit/fit.h"

namespace wale::fit {

/// The material file of a fitted scene: all that the scene's material gave, with the fitted values in the place of what
/// says the same. "materials.NAME.file" of a scene reads it.
std::string material_json(const Scene& scene, const FitTarget& target);

/// `--set` options for what was fitted beside the material, each on a line of its own; empty: nothing was.
std::string other_settings(const Scene& scene, const FitTarget& target, std::span<const FitParameter> parameters);

}  // namespace wale::fit
