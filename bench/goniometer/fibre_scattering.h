#pragma once
#include "bench/goniometer/random_numbers.h"
#include "geom/vec.h"

namespace wale {

/// Which longitudinal function the fibres of a bundle scatter by.
enum class Longitudinal {
  gaussian,  ///< Gaussian about the cone times cos^2: Khungurn et al. 2016, "Matching Real Fabrics", section 4
  d_eon      ///< d'Eon et al. 2011, equation 7, variance beta^2: the renderer's explicit fibres
};

/// One fibre seen from far away: R reflected at its surface, TT gone through it. Angles and widths in radians.
///   R  = F M(beta_r) / (2 pi)          F = reflect + (1 - reflect) (1 - cos th_i)^5 (Schlick)
///   TT = (1 - F) transmit M(beta_tt) N, N = Gaussian of standard deviation gamma_tt about straight on, with what lies
///        beyond a half turn spread evenly.
struct FibreScattering {
  dvec3 reflect{0.046};
  dvec3 transmit{1};
  double beta_r = 0.14, beta_tt = 0.35, gamma_tt = 0.61;
  Longitudinal longitudinal = Longitudinal::d_eon;
};

/// A sampled event: unit direction away from the fibre, weight by which the light's colour changes (its mean over many
/// samples is the fibre's albedo), and which lobe it was.
struct FibreEvent {
  dvec3 direction{0};
  dvec3 weight{0};
  bool reflected = false;
};

/// Schlick reflectance at inclination th_i with cosine cos_i.
dvec3 fibre_fresnel(const FibreScattering& fibre, double cos_i);

/// Draws a direction for light arriving from w_i (unit, away from the fibre); axis: unit tangent. Exact: the weight
/// does not depend on the direction drawn.
FibreEvent scatter(const FibreScattering& fibre, dvec3 axis, dvec3 w_i, PathRandom& random);

/// Density of the sine of the outgoing inclination, per unit of it, of a lobe of width beta.
double longitudinal_density(Longitudinal kind, double sin_i, double sin_o, double beta);

/// Density of the azimuth phi_o - phi_i of TT per radian.
double transmit_azimuth_density(double phi, double gamma);

}  // namespace wale
