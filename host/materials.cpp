#include "host/materials.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "geom/error.h"

namespace wale {
namespace {

// The ranges below are those that the scene's schema promises.
constexpr double kDegree = std::numbers::pi / 180;
constexpr double kSharpest = 0.001;  // radians: a highlight sharper than this would be noise

// One row per preset: bundles of dielectric fibres measured and fitted by bench/goniometer from 0 to 60 degrees
// (docs/appearance.md). Angles in degrees, logistic widths in radians, variances in rad^2, twist = tangent of the
// surface fibres' angle to the axis.
struct Preset {
  const char* name;
  double fresnel, beta, twist;
  int fibres;
  double packing, beta_tt, gamma_tt;  ///< the bundle itself, and light that goes through one fibre (degrees)
  double density;                     ///< kg/m^3
  double tau_e, e_r, e_r_h4, b, s_f0, e_f, d_f, s_b, d_b, v_c, v_e, n0, n1, hits_back;
  Rgb color;  ///< transmission of one fibre: undyed yarn
};
// clang-format off
constexpr std::array<Preset, 6> kPresets = {{
    {"cotton",    .0450, 8, .39,  75, .50, 20, 35, 1540,
     2.98, .348, .37, .526, .910, 3.11, 49.4, 1.86, 35.7, .621, .103, .02, 7.61, 1.06, {.965, .955, .930}},
    {"wool",      .0470, 6, .35,  60, .40, 12, 28, 1310,
     2.48, .342, .52, .226, .568, 2.85, 33.7, 1.97, -46.7, .236, .030, .86, 5.51, 1.29, {.930, .895, .820}},
    {"silk",      .0500, 3, .09, 120, .50,  8, 20, 1340,
     3.37, .340, .41, .369, .470, 3.57, 34.6, 2.29, -67.2, .159, .032, 5.77, 2.24, 1.10, {.970, .950, .900}},
    {"polyester", .0550, 4, .16,  72, .50, 10, 22, 1380,
     2.96, .351, .39, .309, .463, 3.33, 32.2, 3.00, -70.0, .193, .038, 2.84, 4.36, 1.07, {.960, .960, .960}},
    {"acrylic",   .0413, 5, .25,  80, .45, 12, 25, 1170,
     2.84, .345, .44, .263, .525, 3.12, 35.2, 1.80, -63.5, .270, .047, 1.58, 5.78, 1.21, {.965, .965, .965}},
    {"mohair",    .0465, 4, .20,  36, .25, 10, 24, 1310,
     1.81, .354, .87, .115, .252, 3.00, 20.2, 1.91, -91.7, .110, .0202, .95, 3.06, 1.53, {.955, .925, .860}},
}};
// clang-format on

void require_range(double value, double low, double high, const char* what) {
  if (!(value >= low && value <= high))
    user_error("material: {} is {}; the nearest valid value is {}", what, value, value > high ? high : low);
}

w_float4 color4(const Rgb& c, const char* what, float w) {
  for (const double v : c) require_range(v, 0, 1, what);
  return {float(c[0]), float(c[1]), float(c[2]), w};
}

double fresnel_of(double ior) {
  const double r = (ior - 1) / (ior + 1);
  return r * r;
}

const Preset& preset_of(const PlyAppearance& appearance) {
  const auto preset =
      std::find_if(kPresets.begin(), kPresets.end(), [&](const Preset& p) { return appearance.preset == p.name; });
  if (preset == kPresets.end())
    user_error("material: no ply preset is called '{}'; there are {}", appearance.preset,
               fmt::join(ply_presets(), ", "));
  return *preset;
}

}  // namespace

const std::vector<std::string>& ply_presets() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> out;
    for (const Preset& p : kPresets) out.push_back(p.name);
    return out;
  }();
  return names;
}

WPlyMaterial ply_material(const PlyAppearance& appearance) {
  const Preset* preset = &preset_of(appearance);
  if (appearance.forward.has_value() != appearance.back.has_value())
    user_error("material: the body colours 'forward' and 'back' come together; '{}' is missing",
               appearance.forward ? "back" : "forward");

  WPlyMaterial m{};
  const bool direct = appearance.forward.has_value();
  m.fibre = color4(appearance.color.value_or(preset->color), "color", direct ? 1.0f : 0.0f);
  if (direct) {
    m.forward = color4(*appearance.forward, "forward", 0);
    m.back = color4(*appearance.back, "back", 0);
  }
  const double roughness = appearance.roughness.value_or(preset->beta * kDegree);
  require_range(roughness, 0, std::numbers::pi / 2, "roughness (radians)");
  m.beta_r = float(std::max(roughness, kSharpest));
  m.f0 = float(preset->fresnel);
  if (appearance.ior) {
    require_range(*appearance.ior, 1, 4, "ior");
    m.f0 = float(fresnel_of(*appearance.ior));
  }
  m.tau_e = float(appearance.optical_radius.value_or(preset->tau_e));
  require_range(m.tau_e, 0, 1e4, "optical_radius");
  m.tilt = float(preset->twist);
  if (appearance.fibre_twist) {
    require_range(*appearance.fibre_twist, -89 * kDegree, 89 * kDegree, "fibre_twist (radians)");
    m.tilt = float(std::tan(*appearance.fibre_twist));
  }
  m.e_r = float(preset->e_r);
  m.e_r_h4 = float(preset->e_r_h4);
  m.b = float(preset->b);
  m.s_f0 = float(preset->s_f0);
  m.e_f = float(preset->e_f);
  m.d_f = float(preset->d_f * kDegree);
  m.s_b = float(preset->s_b);
  m.d_b = float(preset->d_b * kDegree);
  m.v_c = float(preset->v_c);
  m.v_e = float(preset->v_e);
  m.n0 = float(preset->n0);
  m.n1 = float(preset->n1);
  m.hits_back = float(preset->hits_back);
  return m;
}

FibreRecipe fibre_recipe(const PlyAppearance& appearance) {
  const Preset& preset = preset_of(appearance);
  FibreRecipe recipe;
  recipe.fibres = appearance.fibres.value_or(preset.fibres);
  recipe.packing = preset.packing;
  recipe.twist = double(ply_material(appearance).tilt);
  return recipe;
}

WFibreMaterial fibre_material(const PlyAppearance& appearance) {
  const Preset& preset = preset_of(appearance);
  const WPlyMaterial ply = ply_material(appearance);
  WFibreMaterial m{};
  m.reflect = {ply.f0, ply.f0, ply.f0, 0};
  m.transmit = ply.fibre;
  m.transmit.w = 0;
  m.beta_r = ply.beta_r;
  m.beta_tt = float(preset.beta_tt * kDegree);
  m.gamma_tt = float(preset.gamma_tt * kDegree);
  return m;
}

double fibre_density(const PlyAppearance& appearance) { return preset_of(appearance).density; }

WSurfaceMaterial surface_material(const SurfaceAppearance& appearance) {
  WSurfaceMaterial m{};
  m.color = color4(appearance.color, "color", 0);
  m.kind = appearance.coated ? 1 : 0;
  m.light = -1;
  require_range(appearance.roughness, 0, 1, "roughness");
  require_range(appearance.ior, 1, 4, "ior");
  m.roughness = float(appearance.roughness);
  m.ior = float(appearance.ior);
  return m;
}

}  // namespace wale
