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
  constexpr size_t kColors = kResidualColors.size();
  Residuals r;
  std::array<SidedLight, kColors> ours{}, theirs{};
  for (const Slices::Slice& slice : s.slices) {
    const Measurement& m = slice.at;
    const BodyHistograms model = ply_body(p, s.theta, slice.h);
    const double tv = total_variation(model.phi, m.phi);
    r.tv_worst = std::max(r.tv_worst, tv);
    r.tv_mean += slice.weight * tv;
    r.tv_noise = std::max(r.tv_noise, total_variation_of_noise(m.phi, double(m.paths) * m.body[0].mean));
    r.tv_theta = std::max(r.tv_theta, total_variation(model.theta, m.theta));
    r.surface +=
        slice.weight * (1 - m.uncollided.mean) * (ply_surface_share(p, s.theta, slice.h) - slice.surface_share());
    for (size_t k = 0; k < kColors; ++k) {
      const SidedLight a = ply_light(p, s.theta, slice.h, kResidualColors[k], model);
      const SidedLight b = sided_light(m, kResidualColors[k]);
      ours[k].returned += slice.weight * a.returned, ours[k].forward += slice.weight * a.forward;
      theirs[k].returned += slice.weight * b.returned, theirs[k].forward += slice.weight * b.forward;
    }
  }
  for (size_t k = 0; k < kColors; ++k) {
    r.returned[k] = ours[k].returned / theirs[k].returned - 1;
    r.forward[k] = ours[k].forward / theirs[k].forward - 1;
  }
  r.returned_dark = ours.back().returned - theirs.back().returned;
  r.uncollided = ply_uncollided_mean(p) - s.whole.uncollided.mean;
  return r;
}

}  // namespace wale
