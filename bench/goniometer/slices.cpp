#include <algorithm>
#include <cmath>
#include <numbers>

#include "bench/goniometer/fit.h"

namespace wale {
namespace {

constexpr std::array<double, 6> kOffsets = {.05, .3, .5, .7, .85, .95};
constexpr std::array<double, 6> kWeights = {.175, .225, .2, .175, .125, .1};  // half-way to the neighbours
constexpr int kSections = 64;

}  // namespace

std::vector<Slices> measure_slices(const FibreRecipe& recipe, const FibreScattering& fibre,
                                   const std::vector<double>& thetas, int64_t paths, uint64_t seed) {
  FibreScattering white = fibre;
  white.transmit = dvec3(1);
  std::vector<Incidence> all;
  const auto add = [&](double theta, double low, double high, int64_t n) {
    all.push_back({theta, low, high, n, seed + 1000 * all.size(), kSections});
  };
  for (const double theta : thetas) {
    for (const double h : kOffsets) add(theta, h, h, paths), add(theta, -h, -h, paths);
    add(theta, -1, 1, 4 * paths);
  }
  const std::vector<Measurement> m = measure(recipe, white, all);
  std::vector<Slices> out;
  size_t next = 0;
  for (const double theta : thetas) {
    Slices s{theta, {}, {}};
    for (size_t i = 0; i < kOffsets.size(); ++i)
      for (const int sign : {1, -1}) s.slices.push_back({sign * kOffsets[i], 0.5 * kWeights[i], m[next++]});
    s.whole = m[next++];
    out.push_back(std::move(s));
  }
  return out;
}

Residuals residuals(const PlyParameters& p, const Slices& s) {
  constexpr std::array<double, 5> kColors = {.5, .7, .85, .95, .99};
  constexpr std::array<double, 3> kBright = {.9, .95, .99};
  Residuals r;
  double forward_model = 0, forward = 0, body = 0, surface = 0, square = 0;
  std::array<double, 3> lost{}, lost_model{};
  AngleHistogram phi_before{};
  for (const Slices::Slice& slice : s.slices) {
    const Measurement& m = slice.at;
    const BodyHistograms model = ply_body(p, s.theta, slice.h);
    const double tv = total_variation(model.phi, m.phi);
    r.tv_worst = std::max(r.tv_worst, tv);
    r.tv_mean += slice.weight * tv;
    r.tv_noise = std::max(r.tv_noise, total_variation_of_noise(m.phi, double(m.paths) * m.body[0].mean));
    r.tv_theta = std::max(r.tv_theta, total_variation(model.theta, m.theta));
    AngleHistogram error = slice.h > 0 ? AngleHistogram{} : phi_before;
    const AngleHistogram theirs = slice.h > 0 ? m.phi : mirrored(m.phi);
    const AngleHistogram ours = slice.h > 0 ? model.phi : mirrored(model.phi);
    double folded = 0;
    for (size_t i = 0; i < kAngleBins; ++i) folded += 0.25 * std::abs(error[i] += ours[i] - theirs[i]);
    if (slice.h > 0)
      phi_before = error;
    else
      r.tv_folded = std::max(r.tv_folded, folded);

    const double w = slice.weight * m.body[0].mean;
    body += w;
    forward += w * m.forward;
    forward_model += w * model.forward;
    surface +=
        slice.weight * (1 - m.uncollided.mean) * (ply_surface_share(p, s.theta, slice.h) - slice.surface_share());
    for (const double c : kColors) {
      const double difference = ply_body_albedo(p, s.theta, slice.h, c) - body_albedo(m, c);
      square += slice.weight * difference * difference / double(kColors.size());
    }
    for (size_t k = 0; k < kBright.size(); ++k) {
      lost[k] += w * (1 - body_albedo(m, kBright[k]));
      lost_model[k] += w * (1 - ply_body_albedo(p, s.theta, slice.h, kBright[k]));
    }
  }
  r.forward = (forward_model - forward) / body;
  r.surface = surface;
  r.uncollided = ply_uncollided_mean(p) - s.whole.uncollided.mean;
  r.color_rms = std::sqrt(square);
  for (size_t k = 0; k < kBright.size(); ++k) r.lost[k] = lost_model[k] / lost[k] - 1;
  return r;
}

}  // namespace wale
