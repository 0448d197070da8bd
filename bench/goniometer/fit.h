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

/// Fibre colours that residuals are given for.
constexpr std::array<double, 5> kResidualColors = {1, .97, .9, .7, .5};

/// What the parameters leave. TV: total variation. Light: over the whole ply, by the slices.
struct Residuals {
  double tv_worst = 0, tv_mean = 0;  ///< azimuth of the body's light, over the offsets and their signs
  double tv_noise = 0;               ///< what noise alone would leave, worst
  double tv_theta = 0;               ///< inclination, worst
  std::array<double, 5> returned{};  ///< relative error of the light that leaves with cos phi > 0, kResidualColors
  std::array<double, 5> forward{};   ///< of the light that leaves with cos phi < 0, without the uncollided
  double returned_dark = 0;          ///< absolute error of the returned light at colour .5
  double uncollided = 0;             ///< error of T0, mean over the ply
  double surface = 0;                ///< error of R1, mean over the ply
};
Residuals residuals(const PlyParameters& p, const Slices& s);

/// Parameters that fit all the slices together. Kept as given: f0 and twist.
PlyParameters fit_ply(const std::vector<Slices>& slices, const PlyParameters& given);

}  // namespace wale
