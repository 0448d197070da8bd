#pragma once
#include <cstdint>
#include <vector>

namespace wale {

/// How fibres lie in a ply. Lengths in ply radii R; turns of the bundle are measured by the twist angle
/// theta = kappa s, s the length along the ply, kappa = twist / R.
struct FibreRecipe {
  int fibres = 75;            ///< 1 to 4096
  double packing = 0.5;       ///< share of the ply's section that is fibre, (0, 0.7]: fibre radius sqrt(packing/fibres)
  double radial_beta = 0;     ///< density at R ply radii from the axis, Zhao et al. 2016 section 4.2:
  double radial_epsilon = 0;  ///<   p(R) = (1 - 2 epsilon) ((e - e^R)/(e - 1))^beta + epsilon; beta = 0: uniform
  double twist = 0;           ///< tangent of the angle between fibres on the surface and the axis, signed
  double migration_min = 1;   ///< fibres wander between this share of their distance and all of it; 1 = they do not
  double migration_rate = 1.5;  ///< migrations per turn of the bundle
  uint32_t seed = 1;

  bool operator==(const FibreRecipe&) const = default;
};

/// Fibres of one cross-section, all of one radius. Fibre k lies at azimuth angle + theta about the ply's axis, seen
/// from the ply's frame (n, t x n), and at the distance fibre_distance(...).
struct FibreSection {
  struct Fibre {
    double distance = 0;  ///< from the axis, ply radii, at its outermost
    double angle = 0;     ///< radians
    double phase = 0;     ///< of the migration, radians
  };
  double fibre_radius = 0;  ///< ply radii
  double overlap = 0;       ///< deepest overlap of two fibres left at theta = 0 without migration, fibre radii
  std::vector<Fibre> fibres;
};

/// Radius of each fibre, ply radii. Same errors as make_fibre_section.
double fibre_radius(const FibreRecipe& recipe);

/// Cross-section by rejection against p(R) and against overlap (Zhao et al. 2016, section 4.2), inside radius
/// 1 - fibre radius; where darts find no more room the fibres are pushed apart. Deterministic for a seed. Throws a user
/// error on counts, packings and densities out of range.
FibreSection make_fibre_section(const FibreRecipe& recipe);

/// Distance of a fibre from the axis at twist angle theta (Zhao et al. 2016, equation 3), ply radii.
double fibre_distance(const FibreSection::Fibre& fibre, const FibreRecipe& recipe, double theta);

}  // namespace wale
