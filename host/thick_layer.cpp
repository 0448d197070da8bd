#include "host/thick_layer.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geom/error.h"
#include "shared/ply_shape.h"

namespace wale {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kOffsets = 32, kAngles = 24, kTilts = 12, kTurns = 12;

/// Mean of cos th_o under the longitudinal lobe of variance v about th_i, by its exact sampling (d'Eon 2013) at the
/// midpoints of a grid.
double mean_cos(double sin_i, double cos_i, double v) {
  double sum = 0;
  for (int i = 0; i < kTilts; ++i) {
    const double u = (i + 0.5) / kTilts;
    const double q = std::clamp(-v * std::log(1 - u + u * std::exp(-2 / v)), 0.0, 2.0);
    const double s = std::sqrt(q * (2 - q));
    for (int j = 0; j < kTurns; ++j) {
      const double sin_o = -(1 - q) * sin_i + s * std::cos(kPi * (j + 0.5) / kTurns) * cos_i;
      sum += std::sqrt(std::max(0.0, 1 - sin_o * sin_o));
    }
  }
  return sum / (kTilts * kTurns);
}

/// Mean of -sin th_o / sin th_i under the same lobe: coth(1/v) - v.
double mean_sin_factor(double v) { return 1 / std::tanh(1 / v) - v; }

/// Means of cos x and |sin x| over one side of the logistic cut to [-pi, pi].
struct LogisticSide {
  double cosine = 0, sine = 0;
  explicit LogisticSide(double s) {
    constexpr int kSteps = 256;
    double weights = 0;
    for (int i = 0; i < kSteps; ++i) {
      const double x = kPi * (i + 0.5) / kSteps, e = std::exp(-x / s), w = e / ((1 + e) * (1 + e));
      cosine += w * std::cos(x);
      sine += w * std::sin(x);
      weights += w;
    }
    cosine /= weights;
    sine /= weights;
  }
};

/// Mean cosine of an azimuth drawn about `center`, with logistic sides of scales below and above that meet at one
/// height.
double mean_cos_logistic(double center, double below, double above) {
  const double low = below * std::tanh(kPi / (2 * below)), high = above * std::tanh(kPi / (2 * above));
  const LogisticSide b(below), a(above);
  const double cosine = (low * b.cosine + high * a.cosine) / (low + high);
  const double sine = (high * a.sine - low * b.sine) / (low + high);
  return cosine * std::cos(center) - sine * std::sin(center);
}

struct Vector {
  double x, y, z;
};
double dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

}  // namespace

ThickLayer::ThickLayer(const WPlyMaterial& m) {
  if (m.fibre.w != 0) bug("ThickLayer of a material with body colours");
  const double v_r = double(m.beta_r) * m.beta_r;
  double total = 0;
  for (int i = 0; i < kOffsets; ++i) {
    const double h = 2 * (i + 0.5) / kOffsets - 1, c = std::sqrt(1 - h * h), k = 2 * h * c;
    const double v = m.v_e + (double(m.v_c) - m.v_e) * c;
    const double s_f = m.s_f0 * std::pow(c, double(m.e_f)) + W_FORWARD_LEAST;
    const double forward_cos =
        mean_cos_logistic(kPi - m.d_f * k, s_f * (1 - W_FORWARD_SKEW * h), s_f * (1 + W_FORWARD_SKEW * h));
    const double back_cos = mean_cos_logistic(std::asin(h) + m.d_b * k, m.s_b, m.s_b);
    const double length_tf = std::sqrt(1 + double(m.tilt) * m.tilt);
    const Vector n{c, h, 0}, tf{-m.tilt * h / length_tf, m.tilt * c / length_tf, 1 / length_tf};
    for (int j = 0; j < kAngles; ++j) {
      // A random line meets a cylinder at latitude th in proportion to cos^2 th (solid angle times width).
      const double theta = kPi * ((j + 0.5) / kAngles - 0.5), sin_v = std::sin(theta), cos_v = std::cos(theta);
      const double weight = (1 - std::exp(-2 * double(m.tau_e) * c)) * cos_v * cos_v;
      const Vector wv{cos_v, 0, sin_v};
      const double sin_f = dot(wv, tf), cos_f = std::sqrt(std::max(0.0, 1 - sin_f * sin_f));
      const double fresnel = m.f0 + (1 - double(m.f0)) * std::pow(1 - cos_f, 5);
      const double surface = std::clamp(fresnel * m.e_r * (1 + m.e_r_h4 * h * h * h * h), 0.0, 1.0);

      // Cosine between the way in, -wv, and the mean way out, per lobe. In the frame of a lobe's axis wv = (cos, 0,
      // sin).
      const double towards = std::clamp(W_BODY_LEAN_DECAY * m.tilt * h * sin_v, -3.0, 3.0);
      const double forward = std::exp(-m.b * (1 + W_BODY_GRAZE * std::pow(1 - cos_v, 2)) * std::exp(towards) * c);
      const double theta_b = theta - std::atan(W_BODY_LEAN * m.tilt * h), sin_b = std::sin(theta_b);
      const double cos_b = std::abs(std::cos(theta_b));
      const double body_cos = mean_cos(sin_b, cos_b, v), body_sin = sin_b * sin_b * mean_sin_factor(v);
      const double g_f = body_sin - cos_b * body_cos * forward_cos;
      const double g_b = body_sin - cos_b * body_cos * back_cos;
      // The normal's azimuth about the surface fibres, whose frame turns wv into (cos_f, 0, sin_f).
      const double facing = cos_f > 1e-9 ? std::clamp(dot(n, wv) / cos_f, 0.0, 1.0) : 1;
      const double g_r = sin_f * sin_f * mean_sin_factor(v_r) - cos_f * mean_cos(sin_f, cos_f, v_r) * facing * kPi / 4;
      total += weight;
      const double hits = m.n0 + m.n1 * c;
      nodes_.push_back(
          {weight, surface, forward, fresnel, std::max(hits, 1.0), std::max(m.hits_back * hits, 1.0), g_r, g_f, g_b});
    }
  }
  for (Node& node : nodes_) node.weight = total > 0 ? node.weight / total : 1.0 / double(nodes_.size());
}

ThickLayer::Scattered ThickLayer::scattered(double fibre) const {
  Scattered out;
  double cosines = 0;
  for (const Node& n : nodes_) {
    const double absorbed = (1 - n.fresnel) * (1 - fibre);
    const auto body = [&](double hits) { return (1 - absorbed) * std::pow(1 + 0.25 * (hits - 1) * absorbed, -4); };
    const double enters = 1 - n.surface, f = body(n.hits), b = body(n.hits_back);
    out.lost += n.weight * enters * (n.forward * (1 - f) + (1 - n.forward) * (1 - b));  // exactly 0 where white
    cosines += n.weight * (n.surface * n.cos_r + enters * (n.forward * f * n.cos_f + (1 - n.forward) * b * n.cos_b));
  }
  // Of what is left: the surface's light, which turns back, is most of it where fibres are dark.
  out.cosine = out.lost < 1 ? std::clamp(cosines / (1 - out.lost), -0.99, 0.99) : 0;
  return out;
}

double ThickLayer::mean_cosine(double fibre) const { return scattered(fibre).cosine; }

double ThickLayer::albedo(double fibre) const { return 1 - scattered(fibre).lost; }

double ThickLayer::seen(double fibre) const {
  const Scattered of = scattered(fibre);
  const double s = std::sqrt(std::max(0.0, of.lost / (1 - (1 - of.lost) * of.cosine)));
  return (1 - s) * (1 - 0.139 * s) / (1 + 1.17 * s);
}

namespace {

/// Where a strictly rising function on [0,1] with value 1 at 1 takes the wanted value; 0 below its range.
template <typename Function>
double inverse(const Function& rising, double wanted) {
  if (wanted >= 1) return 1;
  if (wanted <= rising(0)) return 0;
  double low = 0, high = 1;
  for (int i = 0; i < 52; ++i) {
    const double middle = 0.5 * (low + high);
    (rising(middle) < wanted ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

double ThickLayer::fibre(double wanted) const {
  return inverse([&](double c) { return seen(c); }, wanted);
}

double ThickLayer::fibre_of_albedo(double wanted) const {
  return inverse([&](double c) { return albedo(c); }, wanted);
}

Rgb ThickLayer::fibre(const Rgb& c) const { return {fibre(c[0]), fibre(c[1]), fibre(c[2])}; }
Rgb ThickLayer::seen(const Rgb& c) const { return {seen(c[0]), seen(c[1]), seen(c[2])}; }

}  // namespace wale
