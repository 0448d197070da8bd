#include "bench/goniometer/ply_model.h"
#include "shared/ply_shape.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace wale {
namespace {

constexpr double kPi = std::numbers::pi;

double chord(double h) { return std::sqrt(std::max(0.0, 1 - h * h)); }

/// A lobe about `center`: logistics of scale `below` before it and `above` behind it, cut at a half turn.
class Lobe {
 public:
  Lobe(double center, double below, double above)
      : center_(center),
        below_(below),
        above_(above),
        mass_below_(below * std::tanh(kPi / (2 * below))),
        mass_above_(above * std::tanh(kPi / (2 * above))) {}

  /// Its mass from any fixed angle to x.
  double until(double x) const {
    const double turn = std::floor((x - center_ + kPi) / (2 * kPi)), y = x - center_ - 2 * kPi * turn;
    const double s = y < 0 ? below_ : above_;
    return turn + (mass_below_ + s * std::tanh(y / (2 * s))) / (mass_below_ + mass_above_);
  }

 private:
  double center_, below_, above_, mass_below_, mass_above_;
};

/// Adds w, spread evenly over a width of kAngleBins / kFineBins bins about `at` (in bins), to one or two bins.
void deposit(AngleHistogram& out, double at, double w) {
  constexpr double kHalf = 0.5 * kAngleBins / kFineBins;
  const double border = std::round(at), below = std::clamp((border - at + kHalf) / (2 * kHalf), 0.0, 1.0);
  const auto bin = [](double i) { return size_t((int(i) + kAngleBins) % kAngleBins); };
  out[bin(border - 1)] += w * below;
  out[bin(border)] += w * (1 - below);
}

}  // namespace

PlyParameters ply_parameters(const WPlyMaterial& m) {
  PlyParameters p;
  p.tau_e = m.tau_e, p.e_r = m.e_r, p.e_r_h4 = m.e_r_h4;
  p.b = m.b, p.s_f0 = m.s_f0, p.e_f = m.e_f, p.d_f = m.d_f, p.s_b = m.s_b, p.d_b = m.d_b;
  p.v_c = m.v_c, p.v_e = m.v_e, p.n0 = m.n0, p.n1 = m.n1, p.hits_back = m.hits_back;
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

LobeAzimuths ply_lobe_azimuths(const PlyParameters& p, double h) {
  const double c = chord(h), k = 2 * h * c, s_f = p.s_f0 * std::pow(std::max(c, 1e-9), p.e_f) + W_FORWARD_LEAST;
  const Lobe f(kPi - p.d_f * k, s_f * (1 - W_FORWARD_SKEW * h), s_f * (1 + W_FORWARD_SKEW * h));
  const Lobe b(std::asin(h) + p.d_b * k, p.s_b, p.s_b);
  LobeAzimuths out;
  double f_before = f.until(-kPi), b_before = b.until(-kPi);
  for (int i = 0; i < kFineBins; ++i) {
    const double x = -kPi + 2 * kPi * (i + 1) / kFineBins, f_until = f.until(x), b_until = b.until(x);
    out.forward[size_t(i)] = f_until - f_before;
    out.back[size_t(i)] = b_until - b_before;
    f_before = f_until, b_before = b_until;
  }
  return out;
}

double ply_forward_weight(const PlyParameters& p, double theta, double h) {
  const double graze = 1 - std::cos(theta);
  const double towards = std::clamp(W_BODY_LEAN_DECAY * p.twist * h * std::sin(theta), -3.0, 3.0);
  return std::exp(-p.b * (1 + W_BODY_GRAZE * graze * graze) * std::exp(towards) * chord(h));
}

BodyTurn::BodyTurn(const PlyParameters& p, double theta, double h) {
  const double v = p.v_e + (p.v_c - p.v_e) * chord(h);
  // The body's axis lies in the plane of t and the light: tilted by `lean` towards the light where positive.
  const double lean = -std::atan(W_BODY_LEAN * p.twist * h), theta_b = theta + lean;
  constexpr int kAlong = kFineBins;
  std::array<double, kAlong> m{};
  double sum = 0;
  for (int j = 0; j < kAlong; ++j) {
    const double angle = -kPi / 2 + kPi * (j + 0.5) / kAlong;
    m[size_t(j)] =
        std::cos(angle) * longitudinal_density(Longitudinal::d_eon, std::sin(theta_b), std::sin(angle), std::sqrt(v));
    sum += m[size_t(j)];
  }
  for (int i = 0; i < kFineBins; ++i) {
    const double phi_b = -kPi + 2 * kPi * (i + 0.5) / kFineBins;
    for (int j = 0; j < kAlong; ++j) {
      const double angle = -kPi / 2 + kPi * (j + 0.5) / kAlong, w = m[size_t(j)] / sum;
      const double s = std::sin(angle), x = std::cos(angle) * std::cos(phi_b), y = std::cos(angle) * std::sin(phi_b);
      const double xt = x * std::cos(lean) + s * std::sin(lean), st = s * std::cos(lean) - x * std::sin(lean);
      deposit(phi[size_t(i)], (std::atan2(y, xt) + kPi) / (2 * kPi) * kAngleBins, w);
      deposit(inclination[size_t(i)], (std::asin(std::clamp(st, -1.0, 1.0)) + kPi / 2) / kPi * kAngleBins, w);
      back[size_t(i)] += xt > 0 ? w : 0;
    }
  }
}

BodyHistograms ply_body(const PlyParameters& p, double theta, double h) {
  return ply_body(p, theta, h, BodyTurn(p, theta, h));
}

BodyHistograms ply_body(const PlyParameters& p, double theta, double h, const BodyTurn& turn) {
  const LobeAzimuths lobes = ply_lobe_azimuths(p, h);
  const double forward = ply_forward_weight(p, theta, h);
  BodyHistograms out;
  for (size_t i = 0; i < kFineBins; ++i) {
    const double mass = forward * lobes.forward[i] + (1 - forward) * lobes.back[i];
    out.back_of_f += lobes.forward[i] * turn.back[i];
    out.back_of_b += lobes.back[i] * turn.back[i];
    for (size_t k = 0; k < kAngleBins; ++k) {
      out.phi[k] += mass * turn.phi[i][k];
      out.theta[k] += mass * turn.inclination[i][k];
    }
  }
  out.forward = 1 - forward * out.back_of_f - (1 - forward) * out.back_of_b;
  return out;
}

BodyAlbedo ply_lobe_albedo(const PlyParameters& p, double theta, double h, double c) {
  const double f = ply_fresnel(p, theta, h), omega = f + (1 - f) * c, hits = p.n0 + p.n1 * chord(h);
  const auto albedo = [&](double n) { return omega * std::pow(1 + (std::max(1.0, n) - 1) * (1 - omega) / 4, -4.0); };
  return {albedo(hits), albedo(p.hits_back * hits)};
}

double ply_body_albedo(const PlyParameters& p, double theta, double h, double c) {
  const double forward = ply_forward_weight(p, theta, h);
  const BodyAlbedo albedo = ply_lobe_albedo(p, theta, h, c);
  return forward * albedo.forward + (1 - forward) * albedo.back;
}

SidedLight ply_light(const PlyParameters& p, double theta, double h, double c, const BodyHistograms& body) {
  const double forward = ply_forward_weight(p, theta, h), collided = 1 - ply_uncollided(p, h);
  const double surface = ply_surface_share(p, theta, h);
  const BodyAlbedo albedo = ply_lobe_albedo(p, theta, h, c);
  const double f = (1 - surface) * forward * albedo.forward, b = (1 - surface) * (1 - forward) * albedo.back;
  // Half of R's cosine lobe about the normal and what of the other half is on the light's side.
  const double returned = surface * 0.5 * (1 + chord(h)) + f * body.back_of_f + b * body.back_of_b;
  return {collided * returned, collided * (surface + f + b - returned)};
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
