#include "host/fit/material_json.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "host/json_text.h"
#include "host/scattering_keys.h"

namespace wale::fit {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kDegree = std::numbers::pi / 180;

// Five digits: more than any fit knows.
double short_number(double value) {
  if (value == 0 || !std::isfinite(value)) return value;
  const double unit = std::pow(10.0, 4 - std::floor(std::log10(std::abs(value))));
  return std::round(value * unit) / unit;
}

Json color(const Rgb& c) { return Json::array({short_number(c[0]), short_number(c[1]), short_number(c[2])}); }

template <typename T>
void put(Json& to, const char* key, const std::optional<T>& value) {
  if (!value) return;
  if constexpr (std::is_same_v<T, Rgb>)
    to[key] = color(*value);
  else if constexpr (std::is_same_v<T, double>)
    to[key] = short_number(*value);
  else
    to[key] = *value;
}

std::optional<double> degrees(const std::optional<double>& radians) {
  return radians ? std::optional(*radians / kDegree) : std::nullopt;
}

Json fibres_json(const Fibres& f) {
  Json out = Json::object();
  put(out, "count", f.count);
  put(out, "packing", f.packing);
  put(out, "twist", degrees(f.twist));
  put(out, "radial_beta", f.radial_beta);
  put(out, "radial_epsilon", f.radial_epsilon);
  put(out, "migration_min", f.migration_min);
  put(out, "migration_rate", f.migration_rate);
  put(out, "seed", f.seed);
  put(out, "transmit_width", degrees(f.transmit_width));
  put(out, "transmit_azimuth_width", degrees(f.transmit_azimuth_width));
  return out;
}

}  // namespace

std::string material_json(const Scene& scene, const FitTarget& target) {
  const PlyAppearance& y = scene.materials[target.material].yarn;
  Json out;
  out["type"] = "ply";
  out["preset"] = y.preset;
  put(out, "color", y.color);
  put(out, "fibre_color", y.fibre_color);
  put(out, "transmit", y.forward);
  put(out, "reflect", y.back);
  put(out, "roughness", degrees(y.roughness));
  put(out, "gloss", y.gloss);
  put(out, "ior", y.ior);
  put(out, "optical_radius", y.optical_radius);
  put(out, "translucency", y.translucency);
  put(out, "fibre_twist", degrees(y.fibre_twist));
  Json scattering = Json::object();
  for (const ScatteringKey& k : kScatteringKeys)
    put(scattering, k.key, k.angle ? degrees(y.scattering.*k.given) : y.scattering.*k.given);
  if (!scattering.empty()) out["scattering"] = scattering;
  if (const Json fibres = fibres_json(y.fibres); !fibres.empty()) out["fibres"] = fibres;
  return json_text(parse_json(out.dump(), "material"));
}

std::string other_settings(const Scene& scene, const FitTarget& target, std::span<const FitParameter> parameters) {
  std::string out;
  for (const FitParameter& p : parameters) {
    const std::string name = p.group->name;
    if (name == "exposure") out += fmt::format("--set film.exposure={:g}\n", short_number(scene.film.exposure));
    if (!p.group->geometry) continue;
    for (const size_t f : target.fabrics) {
      const FabricSpec& spec = scene.fabrics[f].spec;  // of its own hand
      const double value = name == "twist_pitch" ? spec.twist_pitch : spec.thickness;
      out += fmt::format("--set fabrics.{}.yarn.{}={:g}\n", f, name, short_number(value));
    }
  }
  return out;
}

}  // namespace wale::fit
