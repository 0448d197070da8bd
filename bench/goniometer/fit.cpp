#include "bench/goniometer/fit.h"

#include <cmath>
#include <functional>
#include <memory>
#include <nlopt.hpp>
#include <numbers>

namespace wale {
namespace {

using Cost = std::function<double(const std::vector<double>&)>;

double call(const std::vector<double>& x, std::vector<double>&, void* cost) { return (*static_cast<Cost*>(cost))(x); }

/// Subplex (Rowan 1990) from x within the bounds; derivative-free, deterministic.
std::vector<double> minimise(Cost cost, std::vector<double> x, const std::vector<double>& low,
                             const std::vector<double>& high) {
  nlopt::opt search(nlopt::LN_SBPLX, unsigned(x.size()));
  search.set_lower_bounds(low);
  search.set_upper_bounds(high);
  search.set_min_objective(call, &cost);
  search.set_ftol_rel(1e-7);
  search.set_maxeval(20000);
  double least = 0;
  search.optimize(x, least);
  return x;
}

template <typename Visit>
void each(const std::vector<Slices>& all, Visit visit) {
  for (const Slices& s : all)
    for (const Slices::Slice& slice : s.slices) visit(s.theta, slice);
}

double fit_uncollided(const std::vector<Slices>& all) {
  double mean = 0;
  for (const Slices& s : all) mean += s.whole.uncollided.mean / double(all.size());
  double low = 0.01, high = 100;  // the mean falls with tau
  for (int i = 0; i < 80; ++i) {
    PlyParameters p;
    p.tau_e = std::sqrt(low * high);
    (ply_uncollided_mean(p) > mean ? low : high) = p.tau_e;
  }
  return std::sqrt(low * high);
}

void fit_surface(const std::vector<Slices>& all, PlyParameters& p) {
  const auto cost = [&](const std::vector<double>& x) {
    PlyParameters q = p;
    q.e_r = x[0], q.e_r_h4 = x[1];
    double sum = 0;
    each(all, [&](double theta, const Slices::Slice& s) {
      const double e = ply_surface_share(q, theta, s.h) - s.surface_share();
      sum += s.weight * (1 - s.at.uncollided.mean) * e * e;
    });
    return sum * 1e4;
  };
  const auto x = minimise(cost, {p.e_r, p.e_r_h4}, {0, 0}, {1, 3});
  p.e_r = x[0], p.e_r_h4 = x[1];
}

void fit_inclination(const std::vector<Slices>& all, PlyParameters& p) {
  const auto cost = [&](const std::vector<double>& x) {
    PlyParameters q = p;
    q.v_c = x[0], q.v_e = x[1];
    double sum = 0;
    each(all, [&](double theta, const Slices::Slice& s) {
      const AngleHistogram model = ply_body(q, theta, s.h).theta;
      for (size_t i = 0; i < kAngleBins; ++i) sum -= s.weight * s.at.theta[i] * std::log(std::max(model[i], 1e-6));
    });
    return sum;
  };
  const auto x = minimise(cost, {p.v_c, p.v_e}, {0.005, 0.005}, {2, 2});
  p.v_c = x[0], p.v_e = x[1];
}

/// Azimuths, returned light and its colour together: a lobe's width decides how much of it comes back.
void fit_body(const std::vector<Slices>& all, PlyParameters& p) {
  static constexpr std::array<double, 4> kColors = {1, .97, .9, .7};
  struct At {
    double theta, h, weight;
    const Measurement* measured;
    std::unique_ptr<BodyTurn> turn;
    std::array<SidedLight, kColors.size()> light;
  };
  constexpr double kOblique = 50 * std::numbers::pi / 180;
  std::vector<At> at;
  each(all, [&](double theta, const Slices::Slice& s) {
    at.push_back({theta, s.h, s.weight, &s.at, std::make_unique<BodyTurn>(p, theta, s.h), {}});
    for (size_t c = 0; c < kColors.size(); ++c) at.back().light[c] = sided_light(s.at, kColors[c]);
  });
  const auto with = [&](const std::vector<double>& x) {
    PlyParameters q = p;
    q.b = x[0], q.s_f0 = x[1], q.e_f = x[2], q.d_f = x[3], q.s_b = x[4], q.d_b = x[5];
    q.n0 = x[6], q.n1 = x[7], q.hits_back = x[8];
    return q;
  };
  const auto cost = [&](const std::vector<double>& x) {
    const PlyParameters q = with(x);
    double sum = 0;
    // Slices follow each other by inclination: sums over the ply end where the next one starts.
    std::array<SidedLight, kColors.size()> ours{}, theirs{};
    for (size_t i = 0; i < at.size(); ++i) {
      const At& a = at[i];
      const BodyHistograms body = ply_body(q, a.theta, a.h, *a.turn);
      const double tv_weight = a.theta > 0 ? .36 : 1;
      for (size_t k = 0; k < kAngleBins; ++k) {
        const double e = 6 * (body.phi[k] - a.measured->phi[k]);
        sum += tv_weight * e * e;
      }
      for (size_t c = 0; c < kColors.size(); ++c) {
        const SidedLight model = ply_light(q, a.theta, a.h, kColors[c], body);
        const SidedLight light = a.light[c];
        ours[c].returned += a.weight * model.returned, ours[c].forward += a.weight * model.forward;
        theirs[c].returned += a.weight * light.returned, theirs[c].forward += a.weight * light.forward;
        const double e = (model.returned - light.returned) / (light.returned + .05);
        if (c == 0) sum += .25 * a.weight * e * e;
      }
      if (i + 1 < at.size() && at[i + 1].theta == a.theta) continue;
      const double w = a.theta > kOblique ? 6 : (a.theta > 0 ? 16 : 36);
      for (size_t c = 0; c < kColors.size(); ++c) {
        const double e = ours[c].returned / theirs[c].returned - 1, f = ours[c].forward / theirs[c].forward - 1;
        sum += w * (e * e + f * f);
      }
      ours = theirs = {};
    }
    return sum;
  };
  const std::vector<double> low = {0, 0.05, 0, -1.2, 0.2, -1.6, 0, 0, 0.8};
  const std::vector<double> high = {8, 2, 5, 1.6, 3, 1.6, 100, 200, 3};  // at scale 3 a lobe is uniform within 10 %
  auto x = minimise(cost, {0.3, 0.5, 2.8, 0.6, 2, -0.8, 1.5, 5, 1.15}, low, high);
  p = with(minimise(cost, x, low, high));
}

}  // namespace

PlyParameters fit_ply(const std::vector<Slices>& slices, const PlyParameters& given) {
  PlyParameters p = given;
  const std::vector<Slices> normal(slices.begin(), slices.begin() + 1);  // T0 and R1 are the ply's at normal incidence
  p.tau_e = fit_uncollided(normal);
  fit_surface(normal, p);
  fit_inclination(slices, p);
  fit_body(slices, p);
  fit_inclination(slices, p);
  return p;
}

}  // namespace wale
