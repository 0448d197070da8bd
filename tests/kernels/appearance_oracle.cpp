#include "tests/kernels/appearance_oracle.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace wale::test {
namespace {

constexpr double kPi = std::numbers::pi;

double log_bessel_i0(double x) {
  if (x < 500) return std::log(std::cyl_bessel_i(0.0, x));
  // Hankel's expansion; the next term is below 1e-9 here.
  return x - 0.5 * std::log(2 * kPi * x) + std::log1p(1 / (8 * x) + 9 / (128 * x * x) + 225 / (3072 * x * x * x));
}

double angle_to_plane(dvec3 w, dvec3 axis) { return std::atan2(glm::dot(w, axis), glm::length(glm::cross(w, axis))); }

void frame(dvec3 axis, dvec3 n, dvec3 wv, dvec3* x, dvec3* y) {
  const double s = glm::dot(axis, wv);
  *x = std::abs(s) > 0.9999 ? n : glm::normalize(wv - s * axis);
  *y = glm::cross(axis, *x);
}

dvec3 rgb(w_float4 c) { return {c.x, c.y, c.z}; }

}  // namespace

double oracle_longitudinal(double theta_i, double theta_o, double variance) {
  const double v = variance;
  const double log_sinh = 1 / v + std::log1p(-std::exp(-2 / v)) - std::log(2.0);
  return std::exp(-std::sin(theta_i) * std::sin(theta_o) / v +
                  log_bessel_i0(std::cos(theta_i) * std::cos(theta_o) / v) - std::log(2 * v) - log_sinh);
}

double oracle_trimmed_logistic(double x, double s) {
  const double wrapped = std::remainder(x, 2 * kPi), c = std::cosh(wrapped / (2 * s));
  return 1 / (4 * s * c * c * std::tanh(kPi / (2 * s)));
}

double oracle_skewed_logistic(double x, double below, double above) {
  // One integral per side of the unnormalised density 1/cosh^2.
  const auto half = [](double s) { return 2 * s * std::tanh(kPi / (2 * s)); };
  const double wrapped = std::remainder(x, 2 * kPi), c = std::cosh(wrapped / (2 * (wrapped < 0 ? below : above)));
  return 1 / (c * c * (half(below) + half(above)));
}

PlyOracle::PlyOracle(const WPlyMaterial& material, dvec3 t, dvec3 n, dvec3 wv) : m_(material), t_(t) {
  n = glm::normalize(n - glm::dot(n, t) * t);
  frame(t, n, wv, &x_, &y_);
  gamma = std::clamp(std::atan2(glm::dot(n, y_), glm::dot(n, x_)), -kPi / 2, kPi / 2);
  h = std::sin(gamma);
  c = std::cos(gamma);
  const double cos_t = std::cos(angle_to_plane(wv, t));
  // The body's axis leans in the plane of t and the viewer.
  t_ = glm::normalize(t - 0.75 * double(m_.tilt) * h * x_);
  x_ = glm::cross(y_, t_);
  theta_v_ = angle_to_plane(wv, t_);
  tf_ = glm::normalize(t + double(m_.tilt) * glm::cross(t, n));
  frame(tf_, n, wv, &xf_, &yf_);
  theta_vf_ = angle_to_plane(wv, tf_);
  phi_n_ = std::clamp(std::atan2(glm::dot(n, yf_), glm::dot(n, xf_)), 0.02 - kPi / 2, kPi / 2 - 0.02);

  const double f0 = m_.f0, fresnel = f0 + (1 - f0) * std::pow(1 - std::cos(theta_vf_), 5);
  const double reflected = std::clamp(fresnel * m_.e_r * (1 + m_.e_r_h4 * std::pow(h, 4)), 0.0, 1.0);
  const double sin_t = glm::dot(wv, t);
  const double decay =
      m_.b * (1 + 3.5 * std::pow(1 - cos_t, 2)) * std::exp(std::clamp(2.25 * m_.tilt * h * sin_t, -3., 3.));
  const double forward = std::exp(-decay * c), chord_hits = m_.n0 + double(m_.n1) * c;
  for (int k = 0; k < 3; ++k) {
    const double omega = fresnel + (1 - fresnel) * rgb(m_.fibre)[k];
    // Whatever collided met a fibre.
    const auto body = [&](double hits) {
      return omega * std::pow(1 + (std::max(1.0, hits) - 1) / 4 * (1 - omega), -4);
    };
    const bool direct = m_.fibre.w != 0;
    energy[0][k] = reflected;
    energy[1][k] = (1 - reflected) * forward * (direct ? rgb(m_.forward)[k] : body(chord_hits));
    energy[2][k] = (1 - reflected) * (1 - forward) * (direct ? rgb(m_.back)[k] : body(m_.hits_back * chord_hits));
  }
}

double PlyOracle::pdf(int lobe, dvec3 w) const {
  if (lobe == 0) {
    const double phi = std::atan2(glm::dot(w, yf_), glm::dot(w, xf_));
    return oracle_longitudinal(theta_vf_, angle_to_plane(w, tf_), double(m_.beta_r) * m_.beta_r) *
           std::max(0.0, std::cos(phi - phi_n_)) / 2;
  }
  const double phi = std::atan2(glm::dot(w, y_), glm::dot(w, x_)), k = 2 * h * c;
  const double variance = m_.v_e + (double(m_.v_c) - m_.v_e) * c;
  const double s_f = m_.s_f0 * std::pow(c, double(m_.e_f)) + 0.25;
  const double azimuth =
      lobe == 1 ? oracle_skewed_logistic(phi - (kPi - m_.d_f * k), s_f * (1 - 0.35 * h), s_f * (1 + 0.35 * h))
                : oracle_trimmed_logistic(phi - (gamma + m_.d_b * k), m_.s_b);
  return oracle_longitudinal(theta_v_, angle_to_plane(w, t_), variance) * azimuth;
}

}  // namespace wale::test
