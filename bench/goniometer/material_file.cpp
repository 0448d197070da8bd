#include "bench/goniometer/material_file.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "geom/error.h"
#include "host/materials.h"

namespace wale {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
using Json = nlohmann::ordered_json;

/// Six significant digits: more would be noise.
double rounded(double x) {
  if (x == 0) return 0;
  const double scale = std::pow(10, 4 - std::floor(std::log10(std::abs(x))));
  return std::round(x * scale) / scale;
}

double fresnel_of(double ior) { return std::pow((ior - 1) / (ior + 1), 2); }

BundleMaterial of_preset(const std::string& name) {
  PlyAppearance appearance;
  appearance.preset = name;
  const WPlyMaterial ply = ply_material(appearance);
  const WFibreMaterial fibre = fibre_material(appearance);
  BundleMaterial out;
  out.name = name;
  out.recipe = fibre_recipe(appearance);
  out.fibre = {dvec3(double(fibre.reflect.x)), dvec3(1),           double(fibre.beta_r), double(fibre.beta_tt),
               double(fibre.gamma_tt),         Longitudinal::d_eon};
  const double root = std::sqrt(double(ply.f0));
  out.ior = (1 + root) / (1 - root);
  out.color = {double(ply.fibre.x), double(ply.fibre.y), double(ply.fibre.z)};
  return out;
}

}  // namespace

BundleMaterial read_bundle(const std::string& preset_or_file) {
  if (!std::filesystem::exists(preset_or_file)) return of_preset(preset_or_file);
  BundleMaterial out;
  out.name = std::filesystem::path(preset_or_file).stem();
  try {
    std::ifstream file(preset_or_file);
    const Json json = Json::parse(file), fibres = json.at("fibres");
    out.recipe.fibres = fibres.at("count");
    out.recipe.packing = fibres.at("packing");
    out.recipe.twist = std::tan(fibres.value("twist", 0.0) * kDegree);
    out.recipe.radial_beta = fibres.value("radial_beta", 0.0);
    out.recipe.radial_epsilon = fibres.value("radial_epsilon", 0.0);
    out.ior = json.value("ior", 1.55);
    out.fibre = {dvec3(fresnel_of(out.ior)),
                 dvec3(1),
                 json.at("roughness").get<double>() * kDegree,
                 fibres.at("transmit_width").get<double>() * kDegree,
                 fibres.at("transmit_azimuth_width").get<double>() * kDegree,
                 Longitudinal::d_eon};
    out.color = json.value("fibre_color", out.color);
  } catch (const Json::exception& e) {
    user_error("{}: {}; give fibres, roughness, ior and fibre_color as the fit writes them", preset_or_file, e.what());
  }
  for (const double width : {out.fibre.beta_r, out.fibre.beta_tt, out.fibre.gamma_tt})
    if (!(width > 0.001 && width < 3))
      user_error("{}: a width is {} degrees; give 0.1 to 170", preset_or_file, width / kDegree);
  return out;
}

void write_material(const std::string& path, const BundleMaterial& bundle, const PlyParameters& p) {
  const FibreRecipe& r = bundle.recipe;
  Json json;
  json["type"] = "ply";
  if (const auto& presets = ply_presets(); std::find(presets.begin(), presets.end(), bundle.name) != presets.end())
    json["preset"] = bundle.name;
  json["scattering"] = {{"optical_radius", rounded(p.tau_e)},
                        {"surface_share", rounded(p.e_r)},
                        {"surface_rim", rounded(p.e_r_h4)},
                        {"forward_decay", rounded(p.b)},
                        {"forward_width", rounded(p.s_f0)},
                        {"forward_narrowing", rounded(p.e_f)},
                        {"forward_deflection", rounded(p.d_f / kDegree)},
                        {"backward_width", rounded(p.s_b)},
                        {"backward_deflection", rounded(p.d_b / kDegree)},
                        {"variance_centre", rounded(p.v_c)},
                        {"variance_edge", rounded(p.v_e)},
                        {"hits_edge", rounded(p.n0)},
                        {"hits_chord", rounded(p.n1)},
                        {"hits_back", rounded(p.hits_back)}};
  json["fibres"] = {{"count", r.fibres},
                    {"packing", rounded(r.packing)},
                    {"twist", rounded(std::atan(r.twist) / kDegree)},
                    {"radial_beta", r.radial_beta},
                    {"radial_epsilon", r.radial_epsilon},
                    {"migration_min", r.migration_min},
                    {"migration_rate", r.migration_rate},
                    {"transmit_width", rounded(bundle.fibre.beta_tt / kDegree)},
                    {"transmit_azimuth_width", rounded(bundle.fibre.gamma_tt / kDegree)}};
  json["roughness"] = rounded(bundle.fibre.beta_r / kDegree);
  json["ior"] = rounded(bundle.ior);
  json["fibre_color"] = {rounded(bundle.color[0]), rounded(bundle.color[1]), rounded(bundle.color[2])};
  std::ofstream file(path);
  file << json.dump(2) << '\n';
  if (!file.flush()) user_error("{}: cannot be written; give a folder that exists", path);
}

}  // namespace wale
