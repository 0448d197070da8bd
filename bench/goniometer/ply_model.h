#pragma once
#include <array>

#include "bench/goniometer/measure.h"
#include "shared/wale_types.h"

namespace wale {

/// Parameters of the ply BSDF (docs/appearance.md). Radians; the twist is the tangent of the surface fibres' angle.
struct PlyParameters {
  double tau_e = 3, e_r = 0.32, e_r_h4 = 0.6;
  double b = 1, s_f0 = 0.5, e_f = 1, d_f = 0.5, s_b = 3, d_b = 0;
  double v_c = 0.15, v_e = 0.05;
  double n0 = 2, n1 = 5, hits_back = 1;
  double f0 = 0.046, twist = 0;
};

/// What the renderer's material says.
PlyParameters ply_parameters(const WPlyMaterial& material);

using AngleHistogram = std::array<double, kAngleBins>;

/// T0 at offset h, and its mean over the ply.
double ply_uncollided(const PlyParameters& p, double h);
double ply_uncollided_mean(const PlyParameters& p);

/// Fresnel reflectance for light at inclination theta and offset h, at the angle to the surface fibres.
double ply_fresnel(const PlyParameters& p, double theta, double h);

/// Share of the collided light that the surface reflects.
double ply_surface_share(const PlyParameters& p, double theta, double h);

constexpr int kFineBins = 144;  ///< of azimuth about the body's axis

/// Masses of lobes F and B in azimuth about the body's axis.
struct LobeAzimuths {
  std::array<double, kFineBins> forward, back;
};
LobeAzimuths ply_lobe_azimuths(const PlyParameters& p, double h);

/// Where light of each azimuth about the body's axis goes, seen from the ply's: depends on twist, v_c and v_e alone.
struct BodyTurn {
  BodyTurn(const PlyParameters& p, double theta, double h);
  std::array<AngleHistogram, kFineBins> phi{}, inclination{};
  std::array<double, kFineBins> back{};  ///< share with cos phi > 0
};

/// Directions of the body's light, F and B together, in the measurement's bins; each sums to 1.
struct BodyHistograms {
  AngleHistogram phi{}, theta{};
  double forward = 0;                   ///< share with cos phi < 0
  double back_of_f = 0, back_of_b = 0;  ///< share of each lobe with cos phi > 0
};
BodyHistograms ply_body(const PlyParameters& p, double theta, double h);
BodyHistograms ply_body(const PlyParameters& p, double theta, double h, const BodyTurn& turn);

/// Lobe F's weight in white light.
double ply_forward_weight(const PlyParameters& p, double theta, double h);

/// Light that leaves with cos phi > 0 and < 0, as shares of the light sent; uncollided light is in neither.
SidedLight ply_light(const PlyParameters& p, double theta, double h, double c, const BodyHistograms& body);

/// Albedo of the body for fibres of transmission colour c, lobes F and B.
struct BodyAlbedo {
  double forward, back;
};
BodyAlbedo ply_lobe_albedo(const PlyParameters& p, double theta, double h, double c);
/// Of both together.
double ply_body_albedo(const PlyParameters& p, double theta, double h, double c);

/// Azimuths of surface light about the axis for the cosine lobe about the normal, in the measurement's bins; sum 1.
AngleHistogram ply_surface_azimuth(double h);

/// Half the sum of absolute differences.
double total_variation(const AngleHistogram& a, const AngleHistogram& b);

/// What total variation comes out between a distribution and n samples of it, on average.
double total_variation_of_noise(const AngleHistogram& p, double n);

/// phi -> -phi.
AngleHistogram mirrored(const AngleHistogram& a);

}  // namespace wale
