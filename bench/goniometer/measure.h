#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "bench/goniometer/bundle.h"
#include "bench/goniometer/fibre_scattering.h"

namespace wale {

constexpr int kAngleBins = 36;  ///< of azimuth over [-pi, pi) and of inclination over [-pi/2, pi/2]
constexpr int kHitBins = 256;   ///< passages through a fibre, the last bin holds all above

/// Where and how often light is sent at the bundle.
struct Incidence {
  double theta = 0;               ///< inclination to the normal plane, radians; azimuth 0
  double h_low = -1, h_high = 1;  ///< offset across the ply, drawn evenly from this range; equal: fixed
  int64_t paths = 30000;
  uint64_t seed = 1;
  int sections = 8;  ///< cross-sections the paths are shared between
};

/// A mean and its standard error.
struct Estimate {
  double mean = 0, error = 0;
};

/// What came back, as shares of the light sent. Azimuth phi about the axis, 0 on the light's side; "body" is everything
/// but the uncollided light and the light that was reflected once and left.
struct Measurement {
  int64_t paths = 0;
  Estimate uncollided;                            ///< T0
  std::array<Estimate, 3> surface, body;          ///< R1 and M, RGB
  Estimate total;                                 ///< T0 + R1 + M, mean over RGB
  double forward = 0;                             ///< share of the body's light that leaves with cos phi < 0
  double exit_half = 0;                           ///< share of it that leaves from the half that faces the light
  double theta_mean = 0, theta_sd = 0;            ///< of th_o + th_i, radians
  double events = 0;                              ///< fibres met by a path, collided paths only
  double hits = 0;                                ///< passages (TT) through fibres, mean over the body's light
  std::array<double, kAngleBins> phi{}, theta{};  ///< of the body's light, sum 1
  std::array<double, kAngleBins> surface_phi{};   ///< of the surface's light, sum 1
  std::array<double, kHitBins> hits_forward{}, hits_back{};  ///< body's light by number of passages; both sum to 1
};

/// Sends light at bundles made by the recipe (seeds recipe.seed, recipe.seed + 1, ...). threads = 0: all of the
/// machine's. The result does not depend on the number of threads.
Measurement measure(const FibreRecipe& recipe, const FibreScattering& fibre, const Incidence& incidence,
                    int threads = 0);

/// The same for several incidences, with the bundles made once.
std::vector<Measurement> measure(const FibreRecipe& recipe, const FibreScattering& fibre,
                                 const std::vector<Incidence>& incidences, int threads = 0);

/// Albedo of the body for fibres of transmission colour c (grey), from a white measurement: directions do not depend on
/// the colour, so it is the mean of c to the number of passages.
double body_albedo(const Measurement& white, double c);

/// Light that leaves with cos phi > 0 and < 0 for fibres of transmission colour c (grey), from a white measurement;
/// shares of the light sent, without the uncollided.
struct SidedLight {
  double returned, forward;
};
SidedLight sided_light(const Measurement& white, double c);

}  // namespace wale
