#include "host/fit/parameter.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

#include "geom/error.h"
#include "host/materials.h"
#include "host/suggest.h"
#include "shared/wale_types.h"

namespace wale::fit {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

PlyAppearance& yarn_of(Scene& scene, const FitTarget& target) { return scene.materials[target.material].yarn; }
const PlyAppearance& yarn_of(const Scene& scene, const FitTarget& target) {
  return scene.materials[target.material].yarn;
}

/// Colour of the plies where the scene gives none for lights from one side alone.
Rgb own_color(const PlyAppearance& yarn) {
  if (yarn.color) return *yarn.color;
  const WPlyMaterial m = ply_material(yarn);
  return {m.fibre.x, m.fibre.y, m.fibre.z};
}

double get_transmit(const Scene& s, const FitTarget& t, int k) {
  const PlyAppearance& yarn = yarn_of(s, t);
  return (yarn.forward ? *yarn.forward : own_color(yarn))[size_t(k)];
}
double get_reflect(const Scene& s, const FitTarget& t, int k) {
  const PlyAppearance& yarn = yarn_of(s, t);
  return (yarn.back ? *yarn.back : own_color(yarn))[size_t(k)];
}

// Both body colours come together.
void give_bodies(PlyAppearance& yarn) {
  if (yarn.forward) return;
  const Rgb own = own_color(yarn);
  yarn.forward = yarn.back = own;
  yarn.color = yarn.fibre_color = std::nullopt;
}

const std::array<ParameterGroup, 12> kGroups = {{
    {"transmit", 3, 0.02, 0.999, false, true, false, "", "colour of body light that leaves a ply forward", get_transmit,
     [](Scene& s, const FitTarget& t, int k, double v) {
       give_bodies(yarn_of(s, t));
       (*yarn_of(s, t).forward)[size_t(k)] = v;
     },
     W_GRADIENT_TRANSMIT},
    {"reflect", 3, 0.02, 0.999, false, true, false, "", "colour of body light that turns back", get_reflect,
     [](Scene& s, const FitTarget& t, int k, double v) {
       give_bodies(yarn_of(s, t));
       (*yarn_of(s, t).back)[size_t(k)] = v;
     },
     W_GRADIENT_REFLECT},
    {"roughness", 1, 2, 40, true, true, false, "degrees", "width of the surface's highlight: gloss",
     [](const Scene& s, const FitTarget& t, int) { return ply_material(yarn_of(s, t)).beta_r / kDegree; },
     [](Scene& s, const FitTarget& t, int, double v) {
       yarn_of(s, t).gloss = std::nullopt;
       yarn_of(s, t).roughness = v * kDegree;
     },
     W_GRADIENT_ROUGHNESS, [](double) { return kDegree; }},
    {"optical_radius", 1, 0.3, 8, true, true, false, "", "optical thickness: how little passes a ply untouched",
     [](const Scene& s, const FitTarget& t, int) { return double(ply_material(yarn_of(s, t)).tau_e); },
     [](Scene& s, const FitTarget& t, int, double v) {
       yarn_of(s, t).translucency = yarn_of(s, t).scattering.optical_radius = std::nullopt;
       yarn_of(s, t).optical_radius = v;
     }},
    {"fibre_twist", 1, -40, 40, false, true, false, "degrees", "angle of the surface fibres to the ply axis",
     [](const Scene& s, const FitTarget& t, int) { return std::atan(ply_material(yarn_of(s, t)).tilt) / kDegree; },
     [](Scene& s, const FitTarget& t, int, double v) { yarn_of(s, t).fibre_twist = v * kDegree; }, W_GRADIENT_TILT,
     [](double v) {
       const double tangent = std::tan(v * kDegree);
       return (1 + tangent * tangent) * kDegree;
     }},
    {"ply_shadow", 1, 0.05, 3, true, false, false, "",
     "how fast body light that leaves forward falls along the chord (scattering.forward_decay)",
     [](const Scene& s, const FitTarget& t, int) { return double(ply_material(yarn_of(s, t)).b); },
     [](Scene& s, const FitTarget& t, int, double v) { yarn_of(s, t).scattering.forward_decay = v; }},
    {"surface_share", 1, 0.05, 2, true, false, false, "", "strength of the surface's highlight",
     [](const Scene& s, const FitTarget& t, int) { return double(ply_material(yarn_of(s, t)).e_r); },
     [](Scene& s, const FitTarget& t, int, double v) { yarn_of(s, t).scattering.surface_share = v; }},
    {"forward_width", 1, 0.1, 1.5, true, false, false, "radians", "azimuthal width of light that leaves forward",
     [](const Scene& s, const FitTarget& t, int) { return double(ply_material(yarn_of(s, t)).s_f0); },
     [](Scene& s, const FitTarget& t, int, double v) { yarn_of(s, t).scattering.forward_width = v; }},
    {"backward_width", 1, 0.3, 6, true, false, false, "radians", "azimuthal width of light that turns back",
     [](const Scene& s, const FitTarget& t, int) { return double(ply_material(yarn_of(s, t)).s_b); },
     [](Scene& s, const FitTarget& t, int, double v) { yarn_of(s, t).scattering.backward_width = v; }},
    {"exposure", 1, -6, 6, false, false, false, "stops", "how bright the photographs are against the scene's lights",
     [](const Scene& s, const FitTarget&, int) { return s.film.exposure; },
     [](Scene& s, const FitTarget&, int, double v) { s.film.exposure = v; }, kScalesPictures},
    {"twist_pitch", 1, 2, 40, true, false, true, "yarn radii",
     "length of yarn in which its plies wind once; their hand stays",
     [](const Scene& s, const FitTarget& t, int) { return std::abs(s.fabrics[t.fabrics.front()].spec.twist_pitch); },
     [](Scene& s, const FitTarget& t, int, double v) {
       for (const size_t f : t.fabrics) {
         double& pitch = s.fabrics[f].spec.twist_pitch;
         pitch = std::copysign(v, pitch);
       }
     }},
    {"thickness", 1, 0.5, 1.5, true, false, true, "", "factor on the yarn's radius in the tile",
     [](const Scene& s, const FitTarget& t, int) { return s.fabrics[t.fabrics.front()].spec.thickness; },
     [](Scene& s, const FitTarget& t, int, double v) {
       for (const size_t f : t.fabrics) s.fabrics[f].spec.thickness = v;
     }},
}};

constexpr const char* kOption = "--parameters";

std::vector<std::string> group_names() {
  std::vector<std::string> names;
  for (const ParameterGroup& g : kGroups) names.push_back(g.name);
  return names;
}

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts{""};
  for (const char c : text)
    if (c == at)
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

double bound(const std::string& text, const std::string& name) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
    user_error("{}: {}: bounds are two numbers, for example {}=5..30, not '{}'", kOption, name, name, text);
  return value;
}

}  // namespace

std::span<const ParameterGroup> parameter_groups() { return kGroups; }

std::string FitParameter::name() const {
  return group->count == 1 ? group->name : std::string(group->name) + "." + "rgb"[k];
}

double FitParameter::value(double place) const {
  if (place <= 0) return low;
  if (place >= 1) return high;
  return group->logarithmic ? low * std::pow(high / low, place) : low + (high - low) * place;
}

double FitParameter::place(double value) const {
  if (!(value > low)) return 0;
  if (value >= high) return 1;
  return group->logarithmic ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
}

double FitParameter::steepness(double place) const {
  return group->logarithmic ? value(place) * std::log(high / low) : high - low;
}

std::vector<FitParameter> fit_parameters(const std::string& text) {
  std::vector<FitParameter> out;
  const auto add = [&](const ParameterGroup& group, double low, double high) {
    for (int k = 0; k < group.count; ++k) out.push_back({&group, k, low, high});
  };
  if (text.empty()) {
    for (const ParameterGroup& group : kGroups)
      if (group.usual) add(group, group.low, group.high);
    return out;
  }
  for (const std::string& word : split(text, ',')) {
    const size_t equals = word.find('=');
    const std::string name = word.substr(0, equals);
    const auto group = std::find_if(kGroups.begin(), kGroups.end(), [&](const auto& g) { return g.name == name; });
    if (group == kGroups.end())
      user_error("{}: no parameter is called '{}'; {}", kOption, name, nearest_choice(name, group_names()));
    if (std::any_of(out.begin(), out.end(), [&](const auto& p) { return p.group == &*group; }))
      user_error("{}: {} is named twice", kOption, name);
    double low = group->low, high = group->high;
    if (equals != std::string::npos) {
      const std::string range = word.substr(equals + 1);
      const size_t dots = range.find("..");
      if (dots == std::string::npos)
        user_error("{}: {}: bounds are two numbers, for example {}={:g}..{:g}, not '{}'", kOption, name, name, low,
                   high, range);
      low = bound(range.substr(0, dots), name);
      high = bound(range.substr(dots + 2), name);
      if (!(low < high) || low < group->low || high > group->high)
        user_error("{}: {}: bounds {:g}..{:g}; valid: two numbers in rising order within {:g}..{:g}", kOption, name,
                   low, high, group->low, group->high);
    }
    add(*group, low, high);
  }
  return out;
}

void require_hand(const Scene& scene, const FitTarget& target, std::span<const FitParameter> parameters) {
  const bool twist =
      std::any_of(parameters.begin(), parameters.end(), [](const auto& p) { return p.name() == "twist_pitch"; });
  for (const size_t f : target.fabrics)
    if (twist && scene.fabrics[f].spec.twist_pitch == 0)
      user_error(
          "{}: fabrics.{}.yarn.twist_pitch: 0 is yarn without twist, whose hand a fit does not choose; valid: 2 to "
          "1000, "
          "or -1000 to -2 for left-handed yarn (--set fabrics.{}.yarn.twist_pitch=8)",
          scene.file, f, f);
}

void apply_parameters(Scene& scene, const FitTarget& target, std::span<const FitParameter> parameters,
                      std::span<const double> places) {
  for (size_t i = 0; i < parameters.size(); ++i) {
    const FitParameter& p = parameters[i];
    p.group->set(scene, target, p.k, p.value(places[i]));
  }
}

std::vector<double> places_of(const Scene& scene, const FitTarget& target, std::span<const FitParameter> parameters) {
  std::vector<double> places;
  for (const FitParameter& p : parameters) places.push_back(p.place(p.group->get(scene, target, p.k)));
  return places;
}

}  // namespace wale::fit
