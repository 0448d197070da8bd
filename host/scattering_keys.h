#pragma once
#include <array>
#include <numbers>

#include "host/scene.h"
#include "shared/wale_types.h"

namespace wale {

/// A fitted parameter of the ply BSDF that a scene may set: what it is called, where it is kept and how large it may be
/// (angles in degrees here and in files, in radians in memory).
struct ScatteringKey {
  const char* key;
  std::optional<double> Scattering::*given;
  float WPlyMaterial::*value;
  double low, high;
  bool angle;
  const char* doc;
};

inline constexpr std::array<ScatteringKey, 14> kScatteringKeys = {{
    {"optical_radius", &Scattering::optical_radius, &WPlyMaterial::tau_e, 0, 1e4, false, "tau_e"},
    {"surface_share", &Scattering::surface_share, &WPlyMaterial::e_r, 0, 100, false, "e_r, factor on Fresnel"},
    {"surface_rim", &Scattering::surface_rim, &WPlyMaterial::e_r_h4, 0, 100, false, "e_r_h4, its growth to the rim"},
    {"forward_decay", &Scattering::forward_decay, &WPlyMaterial::b, 0, 100, false, "b"},
    {"forward_width", &Scattering::forward_width, &WPlyMaterial::s_f0, 0, 100, false, "s_f0, logistic scale, radians"},
    {"forward_narrowing", &Scattering::forward_narrowing, &WPlyMaterial::e_f, 0, 20, false, "e_f"},
    {"forward_deflection", &Scattering::forward_deflection, &WPlyMaterial::d_f, -180, 180, true, "d_f"},
    {"backward_width", &Scattering::backward_width, &WPlyMaterial::s_b, 0.05, 100, false,
     "s_b, logistic scale, radians"},
    {"backward_deflection", &Scattering::backward_deflection, &WPlyMaterial::d_b, -180, 180, true, "d_b"},
    {"variance_centre", &Scattering::variance_centre, &WPlyMaterial::v_c, 1e-4, 100, false, "v_c, rad^2"},
    {"variance_edge", &Scattering::variance_edge, &WPlyMaterial::v_e, 1e-4, 100, false, "v_e, rad^2"},
    {"hits_edge", &Scattering::hits_edge, &WPlyMaterial::n0, 0, 1000, false, "n0, fibre hits at the rim"},
    {"hits_chord", &Scattering::hits_chord, &WPlyMaterial::n1, 0, 1000, false, "n1, more of them in the middle"},
    {"hits_back", &Scattering::hits_back, &WPlyMaterial::hits_back, 0.1, 10, false,
     "hits of light that turns back, against all"},
}};

}  // namespace wale
