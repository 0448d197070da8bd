#include "bench/goniometer/fibre_scattering.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace wale {
namespace {

constexpr double kPi = std::numbers::pi;

/// exp(-x) I0(x): the power series below 30, Hankel's expansion (relative error below 1e-9) above.
double scaled_bessel_i0(double x) {
  if (x < 30) {
    double term = 1, sum = 1;
    for (int k = 1; k < 200 && term > 1e-17 * sum; ++k) sum += term *= x * x / (4.0 * k * k);
    return sum * std::exp(-x);
  }
  double term = 1, sum = 1;
  for (int k = 1; k < 16; ++k) sum += term *= (2.0 * k - 1) * (2.0 * k - 1) / (8.0 * k * x);
  return sum / std::sqrt(2 * kPi * x);
}

double sample_sin(Longitudinal kind, double sin_i, double cos_i, double beta, PathRandom& random) {
  if (kind == Longitudinal::gaussian) {
    // Gaussian about the cone, kept with probability cos^2: the outgoing energy's density over theta.
    const double center = -std::asin(std::clamp(sin_i, -1.0, 1.0));
    for (;;) {
      const double theta = center + beta * random.normal(), c = std::cos(theta);
      if (std::abs(theta) < kPi / 2 && random.uniform() < c * c) return std::sin(theta);
    }
  }
  // d'Eon 2013: a von Mises-Fisher lobe about the cone, averaged over azimuth.
  const double v = beta * beta, u = random.uniform();
  const double q = std::clamp(-v * std::log(1 - u + u * std::exp(-2 / v)), 0.0, 2.0);
  const double s = std::sqrt(q * (2 - q));
  return std::clamp(-(1 - q) * sin_i + s * std::cos(2 * kPi * random.uniform()) * cos_i, -1.0, 1.0);
}

}  // namespace

dvec3 fibre_fresnel(const FibreScattering& fibre, double cos_i) {
  const double g = std::max(0.0, 1 - cos_i), g2 = g * g;
  return fibre.reflect + (1.0 - fibre.reflect) * (g2 * g2 * g);
}

FibreEvent scatter(const FibreScattering& fibre, dvec3 axis, dvec3 w_i, PathRandom& random) {
  const double sin_i = std::clamp(glm::dot(w_i, axis), -1.0, 1.0);
  const dvec3 across = w_i - sin_i * axis;
  const double cos_i = std::min(glm::length(across), 1.0);
  // Along the axis there is no azimuth; any will do, as the lobes are then symmetric.
  const dvec3 other = std::abs(axis.x) < 0.7 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
  const dvec3 x = cos_i > 1e-9 ? across / cos_i : glm::normalize(glm::cross(axis, other));
  const dvec3 y = glm::cross(axis, x);

  const dvec3 f = fibre_fresnel(fibre, cos_i), through = (1.0 - f) * fibre.transmit;
  const double r = f.x + f.y + f.z, sum = r + through.x + through.y + through.z;
  FibreEvent event;
  if (!(sum > 0)) return {axis, dvec3(0), true};
  const double choose_r = r / sum;
  event.reflected = random.uniform() < choose_r;
  event.weight = event.reflected ? f / choose_r : through / (1 - choose_r);

  double phi = 2 * kPi * random.uniform();
  if (!event.reflected) {
    const double bend = fibre.gamma_tt * random.normal();
    if (std::abs(bend) < kPi) phi = kPi + bend;
  }
  const double sin_o =
      sample_sin(fibre.longitudinal, sin_i, cos_i, event.reflected ? fibre.beta_r : fibre.beta_tt, random);
  const double cos_o = std::sqrt((1 - sin_o) * (1 + sin_o));
  event.direction = glm::normalize(sin_o * axis + cos_o * (std::cos(phi) * x + std::sin(phi) * y));
  return event;
}

double longitudinal_density(Longitudinal kind, double sin_i, double sin_o, double beta) {
  const double cos_i = std::sqrt(std::max(0.0, 1 - sin_i * sin_i)), cos_o = std::sqrt(std::max(0.0, 1 - sin_o * sin_o));
  if (kind == Longitudinal::d_eon) {
    const double v = beta * beta;
    return scaled_bessel_i0(cos_i * cos_o / v) * std::exp(-(1 + sin_i * sin_o - cos_i * cos_o) / v) /
           (-v * std::expm1(-2 / v));
  }
  const double center = -std::asin(std::clamp(sin_i, -1.0, 1.0));
  const auto gauss = [&](double theta) { return std::exp(-0.5 * (theta - center) * (theta - center) / (beta * beta)); };
  // Normalised by Simpson's rule over +-8 widths.
  const double low = std::max(-kPi / 2, center - 8 * beta), high = std::min(kPi / 2, center + 8 * beta);
  constexpr int kSteps = 400;
  double norm = 0;
  for (int i = 0; i <= kSteps; ++i) {
    const double theta = low + (high - low) * i / kSteps, c = std::cos(theta);
    norm += (i == 0 || i == kSteps ? 1 : (i % 2 ? 4 : 2)) * gauss(theta) * c * c;
  }
  norm *= (high - low) / (3 * kSteps);
  return gauss(std::asin(std::clamp(sin_o, -1.0, 1.0))) * cos_o / norm;  // cos^2 d(theta) = cos d(sin theta)
}

double transmit_azimuth_density(double phi, double gamma) {
  const double bend = std::remainder(phi - kPi, 2 * kPi);
  return std::exp(-0.5 * bend * bend / (gamma * gamma)) / (gamma * std::sqrt(2 * kPi)) +
         std::erfc(kPi / (gamma * std::sqrt(2.0))) / (2 * kPi);
}

}  // namespace wale
