#pragma once
#include <vector>

#include "bench/goniometer/ply_model.h"

namespace wale {

/// White measurements of one bundle at one inclination: at fixed offsets of both signs (twisted bundles tell them apart
/// when the light is oblique), and over the whole ply.
struct Slices {
  double theta = 0;  ///< radians
  struct Slice {
    double h;
    double weight;  ///< of the ply's width that the offset stands for; all add up to 1
    Measurement at;
    double surface_share() const { return at.surface[0].mean / (1 - at.uncollided.mean); }
  };
  std::vector<Slice> slices;  ///< h, -h, next h, ...
  Measurement whole;
};

/// Measures at offsets +-.05 .3 .5 .7 .85 .95, white fibres; paths for each, 64 cross-sections.
std::vector<Slices> measure_slices(const FibreRecipe& recipe, const FibreScattering& fibre,
                                   const std::vector<double>& thetas, int64_t paths, uint64_t seed);

/// What the parameters leave. TV: total variation.
struct Residuals {
  double tv_worst = 0, tv_mean = 0;  ///< azimuth of the body's light, over the offsets and their signs
  double tv_folded = 0;              ///< worst when h and -h are added up
  double tv_noise = 0;               ///< what noise alone would leave, worst
  double tv_theta = 0;               ///< inclination, worst
  double forward = 0;                ///< error of the body's forward share, mean over the ply
  double uncollided = 0;             ///< error of T0, mean over the ply
  double surface = 0;                ///< error of R1, mean over the ply
  double color_rms = 0;              ///< error of the body's albedo for fibre colours .5 .7 .85 .95 .99
  std::array<double, 3> lost{};      ///< relative error of 1 - albedo, mean over the ply, colours .9 .95 .99
};
Residuals residuals(const PlyParameters& p, const Slices& s);

/// Parameters that fit all the slices together; f0 and twist as given.
PlyParameters fit_ply(const std::vector<Slices>& slices, double f0, double twist);

}  // namespace wale
