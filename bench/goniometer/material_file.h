#pragma once
#include <array>
#include <string>

#include "bench/goniometer/fibre_scattering.h"
#include "bench/goniometer/ply_model.h"
#include "geom/fibre_section.h"

namespace wale {

/// A bundle to measure, as a scene's ply material describes it.
struct BundleMaterial {
  std::string name;
  FibreRecipe recipe;
  FibreScattering fibre;  ///< white; the colour is apart
  double ior = 1.55;
  std::array<double, 3> color{1, 1, 1};
};

/// A preset's name, or a JSON file {"fibres": {"count", "packing", "twist" (degrees), "radial_beta", "radial_epsilon",
/// "transmit_width", "transmit_azimuth_width"}, "roughness", "ior", "fibre_color"}, angles in degrees. Throws a user
/// error on what is neither.
BundleMaterial read_bundle(const std::string& preset_or_file);

/// Writes the material with its fitted scattering; angles in degrees.
void write_material(const std::string& path, const BundleMaterial& bundle, const PlyParameters& fit);

}  // namespace wale
