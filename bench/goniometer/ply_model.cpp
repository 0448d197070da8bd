#include "bench/goniometer/ply_model.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace wale {
namespace {

constexpr double kPi = std::numbers::pi;

/// Distribution function of the logistic of scale s cut to [-pi, pi].
double trimmed_logistic_cdf(double x, double s) {
  const auto cdf = [&](double y) { return 0.5 * (1 + std::tanh(y / (2 * s))); };
  return (cdf(x) - cdf(-kPi)) / (cdf(kPi) - cdf(-kPi));
}

/// Mass between angles a < b, any turn, of a lobe about `center`.
double lobe_mass(double a, double b, double center, double s) {
  const auto unrolled = [&](double x) {
    const double turn = std::floor((x - center + kPi) / (2 * kPi));
    return turn + trimmed_logistic_cdf(x - center - 2 * kPi * turn, s);
  };
  return unrolled(b) - unrolled(a);
}

struct Lobes {
  double forward, center_f, s_f, center_b, s_b;
};

Lobes lobes(const PlyParameters& p, double theta, double h) {
  const double b = p.b * (1 + p.forward_graze * std::pow(1 - std::cos(theta), 3));
  const double c = std::sqrt(std::max(0.0, 1 - h * h)), k = 2 * h * c;
  return {std::exp(-b * c), kPi - p.d_f * k, p.s_f0 * std::pow(std::max(c, 1e-9), p.e_f) + 0.05,
          std::asin(h) + p.d_b * k, p.s_b};
}

double body_mass(const Lobes& l, double a, double b) {
  return l.forward * lobe_mass(a, b, l.center_f, l.s_f) + (1 - l.forward) * lobe_mass(a, b, l.center_b, l.s_b);
}

}  // namespace

PlyParameters ply_parameters(const WPlyMaterial& m) {
  PlyParameters p;
  p.tau_e = m.tau_e, p.e_r = m.e_r, p.e_r_h4 = m.e_r_h4;
  p.b = m.b, p.s_f0 = m.s_f0, p.e_f = m.e_f, p.d_f = m.d_f, p.s_b = m.s_b, p.d_b = m.d_b;
  p.v_c = m.v_c, p.v_e = m.v_e, p.n0 = m.n0, p.n1 = m.n1;
  p.f0 = m.f0, p.twist = m.tilt;
  return p;
}

double ply_uncollided(const PlyParameters& p, double h) {
  return std::exp(-2 * p.tau_e * std::sqrt(std::max(0.0, 1 - h * h)));
}

double ply_uncollided_mean(const PlyParameters& p) {
  // Midpoint rule in the azimuth of the normal.
  constexpr int kSteps = 400;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double c = std::cos(0.5 * kPi * (i + 0.5) / kSteps);
    sum += std::exp(-2 * p.tau_e * c) * c;
  }
  return sum * 0.5 * kPi / kSteps;
}

double ply_fresnel(const PlyParameters& p, double theta, double h) {
  const double gamma = std::asin(h);
  const dvec3 wv(std::cos(theta), 0, std::sin(theta)), n(std::cos(gamma), std::sin(gamma), 0), t(0, 0, 1);
  const dvec3 tf = glm::normalize(t + p.twist * glm::cross(t, n));
  const double g = 1 - glm::length(glm::cross(wv, tf));
  return p.f0 + (1 - p.f0) * std::pow(g, 5);
}

double ply_surface_share(const PlyParameters& p, double theta, double h) {
  return std::clamp(ply_fresnel(p, theta, h) * p.e_r * (1 + p.e_r_h4 * std::pow(h, 4)), 0.0, 1.0);
}

AngleHistogram ply_azimuth(const PlyParameters& p, double theta, double h) {
  if (p.body_tilt != 0) return ply_body(p, theta, h).phi;
  const Lobes l = lobes(p, theta, h);
  AngleHistogram out;
  for (int i = 0; i < kAngleBins; ++i)
    out[size_t(i)] = body_mass(l, -kPi + 2 * kPi * i / kAngleBins, -kPi + 2 * kPi * (i + 1) / kAngleBins);
  return out;
}

BodyHistograms ply_body(const PlyParameters& p, double theta, double h) {
  const double c = std::sqrt(std::max(0.0, 1 - h * h)), v = p.v_e + (p.v_c - p.v_e) * c;
  // The body's axis lies in the plane of t and the light: tilted by `lean` towards the light where positive.
  const double lean = -std::atan(p.body_tilt * p.twist * h), theta_b = theta + lean;
  const Lobes l = lobes(p, theta, h);
  const int across = p.body_tilt != 0 ? 144 : kAngleBins, along = p.body_tilt != 0 ? 144 : 8 * kAngleBins;
  std::vector<double> m(size_t(along), 0.0);
  double sum = 0;
  for (int j = 0; j < along; ++j) {
    const double angle = -kPi / 2 + kPi * (j + 0.5) / along;
    m[size_t(j)] =
        std::cos(angle) * longitudinal_density(Longitudinal::d_eon, std::sin(theta_b), std::sin(angle), std::sqrt(v));
    sum += m[size_t(j)];
  }
  BodyHistograms out;
  for (int i = 0; i < across; ++i) {
    const double low = -kPi + 2 * kPi * i / across, step = 2 * kPi / across, phi_b = low + 0.5 * step;
    const double mass = body_mass(l, low, low + step) / sum;
    for (int j = 0; j < along; ++j) {
      const double angle = -kPi / 2 + kPi * (j + 0.5) / along, w = mass * m[size_t(j)];
      // From the body's frame to the axis': a turn in the plane of t and the light.
      const double s = std::sin(angle), x = std::cos(angle) * std::cos(phi_b), y = std::cos(angle) * std::sin(phi_b);
      const double xt = x * std::cos(lean) + s * std::sin(lean), st = s * std::cos(lean) - x * std::sin(lean);
      const double phi = p.body_tilt != 0 ? std::atan2(y, xt) : phi_b;
      out.phi[size_t(std::clamp(int((phi + kPi) / (2 * kPi) * kAngleBins), 0, kAngleBins - 1))] += w;
      out.theta[size_t(std::clamp(int((std::asin(std::clamp(st, -1.0, 1.0)) + kPi / 2) / kPi * kAngleBins), 0,
                                  kAngleBins - 1))] += w;
      out.forward += xt < 0 ? w : 0;
    }
  }
  return out;
}

double ply_body_albedo(const PlyParameters& p, double theta, double h, double c) {
  const double f = ply_fresnel(p, theta, h), omega = f + (1 - f) * c;
  const double nbar = std::max(1.0, p.n0 + p.n1 * std::sqrt(std::max(0.0, 1 - h * h)));
  return omega * std::pow(1 + (nbar - 1) * (1 - omega) / p.hits_shape, -p.hits_shape);
}

AngleHistogram ply_surface_azimuth(double h) {
  const double gamma = std::clamp(std::asin(h), 0.02 - kPi / 2, kPi / 2 - 0.02);
  const auto cdf = [&](double x) { return 0.5 * (1 + std::sin(std::clamp(x - gamma, -kPi / 2, kPi / 2))); };
  AngleHistogram out{};
  for (int i = 0; i < kAngleBins; ++i)
    for (int turn = -1; turn <= 1; ++turn)
      out[size_t(i)] += cdf(-kPi + 2 * kPi * (i + 1) / kAngleBins + 2 * kPi * turn) -
                        cdf(-kPi + 2 * kPi * i / kAngleBins + 2 * kPi * turn);
  return out;
}

double total_variation(const AngleHistogram& a, const AngleHistogram& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += std::abs(a[i] - b[i]);
  return 0.5 * sum;
}

double total_variation_of_noise(const AngleHistogram& p, double n) {
  double sum = 0;
  for (const double q : p) sum += std::sqrt(2 * q * (1 - q) / (kPi * n));
  return 0.5 * sum;
}

AngleHistogram mirrored(const AngleHistogram& a) {
  AngleHistogram out = a;
  std::reverse(out.begin(), out.end());
  return out;
}

}  // namespace wale
