#include "host/materials.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "geom/error.h"
#include "host/scattering_keys.h"
#include "host/thick_layer.h"

namespace wale {
namespace {

// The ranges below are those that the scene's schema promises.
constexpr double kDegree = std::numbers::pi / 180;
constexpr double kSharpest = 0.001;  // radians: a highlight sharper than this would be noise
// At the ends of the artists' scales: the highlight's width, and the fibres' density, against the preset.
constexpr double kGloss = 6, kGlossiest = 0.5 * kDegree, kDullest = 40 * kDegree;
constexpr double kTranslucentTau = 4, kTranslucentDecay = 3;

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

float tangent(double angle, const char* what) {
  if (!(std::abs(angle) < 89 * kDegree))
    user_error("material: {} is {}; valid: above {:.6f}, below {:.6f}", what, angle, -89 * kDegree, 89 * kDegree);
  return float(std::tan(angle));
}

void refuse_both(const PlyAppearance& a) {
  if (a.forward.has_value() != a.back.has_value())
    user_error("material: the body colours 'forward' and 'back' come together; '{}' is missing",
               a.forward ? "back" : "forward");
  const auto exclude = [](bool first, bool second, const char* one, const char* other) {
    if (first && second) user_error("material: '{}' and '{}' exclude each other; give one of them", one, other);
  };
  exclude(a.color.has_value(), a.fibre_color.has_value(), "color", "fibre_color");
  exclude(a.forward.has_value(), a.color || a.fibre_color, "forward and back", "color or fibre_color");
  exclude(a.gloss.has_value(), a.roughness.has_value(), "gloss", "roughness");
  exclude(a.translucency.has_value(), a.optical_radius || a.scattering.optical_radius, "translucency",
          "optical_radius");
  exclude(a.optical_radius.has_value(), a.scattering.optical_radius.has_value(), "optical_radius",
          "scattering.optical_radius");
}

/// beta_R, radians: as given, or the preset's made narrower or wider by the gloss.
double surface_width(const PlyAppearance& a, const Preset& preset) {
  if (a.roughness) {
    require_range(*a.roughness, 0, std::numbers::pi / 2, "roughness (radians)");
    return std::max(*a.roughness, kSharpest);
  }
  const double beta = preset.beta * kDegree;
  if (!a.gloss) return beta;
  require_range(*a.gloss, 0, 1, "gloss");
  return std::clamp(beta * std::pow(kGloss, 1 - 2 * *a.gloss), kGlossiest, kDullest);
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
  refuse_both(appearance);

  WPlyMaterial m{};
  m.f0 = float(preset->fresnel);
  if (appearance.ior) {
    require_range(*appearance.ior, 1, 4, "ior");
    m.f0 = float(fresnel_of(*appearance.ior));
  }
  m.tilt = float(preset->twist);
  if (appearance.fibre_twist) m.tilt = tangent(*appearance.fibre_twist, "fibre_twist (radians)");
  m.tau_e = float(preset->tau_e);
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
  for (const ScatteringKey& k : kScatteringKeys)
    if (const auto& given = appearance.scattering.*k.given) {
      const double unit = k.angle ? kDegree : 1;
      require_range(*given, k.low * unit, k.high * unit, k.key);
      m.*k.value = float(*given);
    }
  if (appearance.optical_radius) {
    require_range(*appearance.optical_radius, 0, 1e4, "optical_radius");
    m.tau_e = float(*appearance.optical_radius);
  }
  if (appearance.translucency) {
    require_range(*appearance.translucency, 0, 1, "translucency");
    const double from_preset = 1 - 2 * *appearance.translucency;
    m.tau_e *= float(std::pow(kTranslucentTau, from_preset));
    m.b *= float(std::pow(kTranslucentDecay, from_preset));
  }
  m.beta_r = float(surface_width(appearance, *preset));

  const bool direct = appearance.forward.has_value();
  m.fibre = color4(appearance.fibre_color.value_or(preset->color), "fibre_color", 0);
  if (appearance.color) {
    color4(*appearance.color, "color", 0);
    m.fibre = color4(ThickLayer(m).fibre(*appearance.color), "fibre colour", 0);
  }
  if (direct) {
    m.fibre.w = 1;
    m.forward = color4(*appearance.forward, "forward", 0);
    m.back = color4(*appearance.back, "back", 0);
  }
  return m;
}

FibreRecipe fibre_recipe(const PlyAppearance& appearance) {
  const Preset& preset = preset_of(appearance);
  const Fibres& given = appearance.fibres;
  FibreRecipe recipe;
  recipe.fibres = given.count.value_or(preset.fibres);
  recipe.packing = given.packing.value_or(preset.packing);
  recipe.twist = given.twist ? tangent(*given.twist, "twist of the fibres (radians)") : ply_material(appearance).tilt;
  recipe.radial_beta = given.radial_beta.value_or(recipe.radial_beta);
  recipe.radial_epsilon = given.radial_epsilon.value_or(recipe.radial_epsilon);
  recipe.migration_min = given.migration_min.value_or(recipe.migration_min);
  recipe.migration_rate = given.migration_rate.value_or(recipe.migration_rate);
  recipe.seed = given.seed.value_or(recipe.seed);
  if (recipe.fibres < 1 || recipe.fibres > 4096)
    user_error("material: {} fibres in a ply; valid: 1 to 4096", recipe.fibres);
  if (!(recipe.packing > 0 && recipe.packing <= 0.7))
    user_error("material: a packing of {}; valid: above 0, up to 0.7", recipe.packing);
  return recipe;
}

WFibreMaterial fibre_material(const PlyAppearance& appearance) {
  const Preset& preset = preset_of(appearance);
  const WPlyMaterial ply = ply_material(appearance);
  WFibreMaterial m{};
  m.reflect = {ply.f0, ply.f0, ply.f0, 0};
  m.transmit = ply.fibre;
  m.transmit.w = 0;
  if (appearance.forward) {
    // Body colours say what many fibres do together: the fibre whose bundle has their mean albedo, by the ply's own
    // law.
    PlyAppearance without = appearance;
    without.forward = without.back = std::nullopt;
    const ThickLayer layer(ply_material(without));
    float* const channels[] = {&m.transmit.x, &m.transmit.y, &m.transmit.z};
    for (size_t k = 0; k < 3; ++k)
      *channels[k] = float(layer.fibre_of_albedo(0.5 * ((*appearance.forward)[k] + (*appearance.back)[k])));
    m.transmit.w = 1;  // colours that vary are tints
  }
  m.beta_r = ply.beta_r;
  const auto width = [](const std::optional<double>& given, double degrees, const char* what) {
    const double radians = given.value_or(degrees * kDegree);
    require_range(radians, 0.01 * kDegree, 90 * kDegree, what);
    return float(radians);
  };
  m.beta_tt = width(appearance.fibres.transmit_width, preset.beta_tt, "transmit_width (radians)");
  m.gamma_tt = width(appearance.fibres.transmit_azimuth_width, preset.gamma_tt, "transmit_azimuth_width (radians)");
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
