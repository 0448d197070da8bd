#pragma once
#include <string>
#include <vector>

#include "geom/fibre_section.h"
#include "host/scene.h"
#include "shared/wale_types.h"

namespace wale {

/// Names of the ply presets, in the order of the documentation.
const std::vector<std::string>& ply_presets();

/// Optical radius and BSDF parameters of an appearance: the preset's measured row (docs/appearance.md), then the
/// scene's overrides. Throws a user error on an unknown preset, one body colour without the other, and values out of
/// range: colours [0,1], roughness [0.001,1] rad, ior [1,3], optical radius [0,100], fibre twist within +-1.4 rad.
WPlyMaterial ply_material(const PlyAppearance& appearance);

/// The fibres that such a ply is made of: count, packing, twist. Same errors as ply_material.
FibreRecipe fibre_recipe(const PlyAppearance& appearance);

/// Scattering of one of its fibres. Same errors as ply_material.
WFibreMaterial fibre_material(const PlyAppearance& appearance);

/// Mass density of the fibre's substance, kg/m^3 (Morton and Hearle, Physical Properties of Textile Fibres, table 5.1).
double fibre_density(const PlyAppearance& appearance);

/// Parameters of a mesh's material, without emission and light. Throws a user error on values out of range: colour
/// [0,1], roughness [0,1], ior [1,3].
WSurfaceMaterial surface_material(const SurfaceAppearance& appearance);

}  // namespace wale
