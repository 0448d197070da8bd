// Fits the ply's parameters to a bundle, and says what they leave.
#include <fmt/core.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "bench/goniometer/commands.h"
#include "bench/goniometer/fit.h"
#include "bench/goniometer/material_file.h"
#include "geom/error.h"

namespace wale {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr std::ptrdiff_t kFitted = 4;      ///< inclinations that the fit sees, of those below
constexpr uint32_t kOtherSections = 1000;  ///< the residuals are taken on cross-sections that the fit has not seen

void print_parameters(const char* what, const PlyParameters& p) {
  fmt::print(
      "{}: tau_e {:.3f}, e_r {:.3f}, e_r_h4 {:.2f}, b {:.3f}, s_f0 {:.3f}, e_f {:.2f}, d_f {:.1f}, s_b {:.2f}, "
      "d_b {:.1f}, v_c {:.3f}, v_e {:.3f}, n0 {:.2f}, n1 {:.2f}, hits_back {:.2f}\n",
      what, p.tau_e, p.e_r, p.e_r_h4, p.b, p.s_f0, p.e_f, p.d_f / kDegree, p.s_b, p.d_b / kDegree, p.v_c, p.v_e, p.n0,
      p.n1, p.hits_back);
}

void print_head() {
  fmt::print(
      "\n| th | TV worst | mean | noise | TV(th) | T0 | R1 | returned 1 | .97 | .9 | .7 | .5 absolute | forward 1 | "
      ".97 | "
      ".9 | .7 |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
}

void print_residuals(const PlyParameters& p, const Slices& s) {
  const Residuals r = residuals(p, s);
  fmt::print(
      "| {:.0f} | {:.3f} | {:.3f} | {:.3f} | {:.3f} | {:+.4f} | {:+.4f} | {:+.1f} % | {:+.1f} % | {:+.1f} % | "
      "{:+.1f} % | {:+.4f} | {:+.1f} % | {:+.1f} % | {:+.1f} % | {:+.1f} % |\n",
      s.theta / kDegree, r.tv_worst, r.tv_mean, r.tv_noise, r.tv_theta, r.uncollided, r.surface, 100 * r.returned[0],
      100 * r.returned[1], 100 * r.returned[2], 100 * r.returned[3], r.returned_dark, 100 * r.forward[0],
      100 * r.forward[1], 100 * r.forward[2], 100 * r.forward[3]);
}

/// Mean passages of the light that leaves forward and of the light that leaves back.
std::pair<double, double> hits_by_side(const Measurement& m) {
  const auto mean = [](const auto& histogram) {
    double sum = 0, weight = 0;
    for (size_t i = 0; i < kHitBins; ++i) sum += double(i) * histogram[i], weight += histogram[i];
    return weight > 0 ? sum / weight : 0;
  };
  return {mean(m.hits_forward), mean(m.hits_back)};
}

/// Model beside measurement, for the plots.
void write_comparison(const std::string& path, const std::string& name, const PlyParameters& p,
                      const std::vector<Slices>& all) {
  nlohmann::ordered_json json;
  json["name"] = name;
  for (const Slices& s : all) {
    nlohmann::ordered_json one{{"theta", s.theta / kDegree}};
    for (const Slices::Slice& slice : s.slices) {
      const Measurement& m = slice.at;
      const BodyHistograms body = ply_body(p, s.theta, slice.h);
      nlohmann::ordered_json row{{"h", slice.h},
                                 {"phi", m.phi},
                                 {"phi_model", body.phi},
                                 {"theta", m.theta},
                                 {"theta_model", body.theta},
                                 {"surface_phi", m.surface_phi},
                                 {"surface_phi_model", ply_surface_azimuth(slice.h)},
                                 {"uncollided", m.uncollided.mean},
                                 {"uncollided_model", ply_uncollided(p, slice.h)},
                                 {"surface", slice.surface_share()},
                                 {"surface_model", ply_surface_share(p, s.theta, slice.h)},
                                 {"forward", m.forward},
                                 {"forward_model", body.forward}};
      for (int i = 0; i <= 20; ++i) {
        row["albedo"].push_back(body_albedo(m, 0.05 * i));
        row["albedo_model"].push_back(ply_body_albedo(p, s.theta, slice.h, 0.05 * i));
      }
      one["slices"].push_back(row);
    }
    json["inclinations"].push_back(one);
  }
  std::ofstream file(path);
  file << json.dump() << '\n';
  if (!file.flush()) user_error("{}: cannot be written; give a folder that exists", path);
}

}  // namespace

void fit_bundle(const Options& options) {
  const BundleMaterial bundle = read_bundle(options.bundle);
  PlyParameters given;
  given.f0 = bundle.fibre.reflect.x;
  given.twist = bundle.recipe.twist;
  const std::vector<double> thetas = {0, 30 * kDegree, 45 * kDegree, 60 * kDegree, 75 * kDegree};
  const auto seen = measure_slices(bundle.recipe, bundle.fibre, thetas, options.paths, options.seed);
  FibreRecipe other = bundle.recipe;
  other.seed += kOtherSections;
  const auto fresh = measure_slices(other, bundle.fibre, thetas, options.paths, options.seed + kOtherSections);

  fmt::print("## {}\n\n", bundle.name);
  const PlyParameters fitted = fit_ply({seen.begin(), seen.begin() + kFitted}, given);
  print_parameters("fitted to 0 to 60 degrees", fitted);
  print_head();
  for (const Slices& s : fresh) print_residuals(fitted, s);
  fmt::print("\nPassages through fibres, light leaving forward and back:");
  for (const Slices& s : fresh) {
    const auto [forward, back] = hits_by_side(s.whole);
    fmt::print(" {:.2f} {:.2f} at {:.0f} degrees;", forward, back, s.theta / kDegree);
  }
  fmt::print("\n\n{} paths for each offset and sign, measured anew on other cross-sections\n\n", options.paths);
  if (options.output.empty()) return;
  std::filesystem::create_directories(options.output);
  const std::string stem = options.output + "/" + bundle.name;
  write_material(stem + ".json", bundle, fitted);
  write_comparison(stem + "_compared.json", bundle.name, fitted, fresh);
}

}  // namespace wale
