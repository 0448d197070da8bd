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
/// scene's overrides; `color` becomes a fibre colour through host/thick_layer.h. Throws a user error on an unknown
/// preset, one body colour without the other, two keys that exclude each other, and values outside the ranges that the
/// scene's schema promises.
WPlyMaterial ply_material(const PlyAppearance& appearance);

/// The fibres that such a ply is made of: count, packing, twist, which is that of the surface fibres unless `fibres`
/// gives another. Same errors as ply_material.
FibreRecipe fibre_recipe(const PlyAppearance& appearance);

/// Scattering of one of its fibres. Same errors as ply_material.
WFibreMaterial fibre_material(const PlyAppearance& appearance);

/// Mass density of the fibre's substance, kg/m^3 (Morton and Hearle, Physical Properties of Textile Fibres, table 5.1).
double fibre_density(const PlyAppearance& appearance);

/// Parameters of a mesh's material, without emission and light. Throws a user error on values out of range: colour
/// [0,1], roughness [0,1], ior [1,4].
WSurfaceMaterial surface_material(const SurfaceAppearance& appearance);

}  // namespace wale
