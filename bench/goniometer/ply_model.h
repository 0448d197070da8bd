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
  double n0 = 2, n1 = 5;
  double f0 = 0.046, twist = 0;

  // Not in the renderer's model, which these defaults are.
  double body_tilt = 0;      ///< body lobes about t - body_tilt twist h x: 1 = the mean fibre along the chord
  double forward_graze = 0;  ///< b grows by 1 + forward_graze (1 - cos th)^3
  double hits_shape = 2;     ///< of the colour law, which is omega (1 + (nbar - 1)(1 - omega)/shape)^-shape
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

/// Directions of the body's light, F and B together, in the measurement's bins; each sums to 1.
struct BodyHistograms {
  AngleHistogram phi{}, theta{};
  double forward = 0;  ///< share with cos phi < 0
};
BodyHistograms ply_body(const PlyParameters& p, double theta, double h);
AngleHistogram ply_azimuth(const PlyParameters& p, double theta, double h);

/// Albedo of the body for fibres of transmission colour c.
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
