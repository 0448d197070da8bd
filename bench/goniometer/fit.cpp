#include "bench/goniometer/fit.h"

#include <cmath>
#include <functional>
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

void fit_azimuth(const std::vector<Slices>& all, PlyParameters& p) {
  constexpr double kWidest = 3;  // a logistic of this scale is uniform within 10 %
  const auto with = [&](const std::vector<double>& x) {
    PlyParameters q = p;
    q.b = x[0], q.s_f0 = x[1], q.e_f = x[2], q.d_f = x[3], q.s_b = x[4], q.d_b = x[5];
    return q;
  };
  // Mean square of the total variation, so that no offset is left far behind.
  const auto cost = [&](const std::vector<double>& x) {
    const PlyParameters q = with(x);
    double sum = 0;
    each(all, [&](double theta, const Slices::Slice& s) {
      const double tv = total_variation(ply_azimuth(q, theta, s.h), s.at.phi);
      sum += tv * tv * tv * tv;
    });
    return std::sqrt(sum);
  };
  double least = 1e9;
  PlyParameters best = p;
  for (const double b : {0.5, 1.5})  // several starts: the cost has side valleys
    for (const double s_b : {0.8, 2.5})
      for (const double d_b : {-0.7, 0.5}) {
        auto x =
            minimise(cost, {b, 0.5, 0.9, 0.5, s_b, d_b}, {0, 0.05, 0, -1.2, 0.2, -1.2}, {6, 2, 2.5, 1.4, kWidest, 1.2});
        x = minimise(cost, x, {0, 0.05, 0, -1.2, 0.2, -1.2}, {6, 2, 2.5, 1.4, kWidest, 1.2});
        if (cost(x) < least) least = cost(x), best = with(x);
      }
  p = best;
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

/// By the light that bright fibres lose, relative: paths meet dozens of plies, so 1 - albedo near white decides how
/// deep a cloth's colour is.
void fit_hits(const std::vector<Slices>& all, PlyParameters& p) {
  const auto cost = [&](const std::vector<double>& x) {
    PlyParameters q = p;
    q.n0 = x[0], q.n1 = x[1];
    double sum = 0;
    each(all, [&](double theta, const Slices::Slice& s) {
      for (const double c : {.9, .95, .99}) {
        const double e = (1 - ply_body_albedo(q, theta, s.h, c)) / (1 - body_albedo(s.at, c)) - 1;
        sum += s.weight * s.at.body[0].mean * e * e;
      }
    });
    return sum;
  };
  const auto x = minimise(cost, {2, 5}, {0, 0}, {100, 200});
  p.n0 = x[0], p.n1 = x[1];
}

}  // namespace

PlyParameters fit_ply(const std::vector<Slices>& slices, double f0, double twist) {
  PlyParameters p;
  p.f0 = f0;
  p.twist = twist;
  p.tau_e = fit_uncollided(slices);
  fit_surface(slices, p);
  fit_azimuth(slices, p);
  fit_inclination(slices, p);
  fit_hits(slices, p);
  return p;
}

}  // namespace wale
