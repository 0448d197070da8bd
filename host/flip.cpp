// LDR-FLIP, section numbers of Andersson et al. 2020 (Proc. ACM Comput. Graph. Interact. Tech. 3, 2).
#include "host/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "geom/vec.h"

namespace wale {
namespace {

using Plane = std::vector<float>;

// sRGB primaries, D65.
const dmat3 kRgbToXyz = glm::transpose(dmat3(0.4124564, 0.3575761, 0.1804375,  //
                                             0.2126729, 0.7151522, 0.0721750,  //
                                             0.0193339, 0.1191920, 0.9503041));
const dvec3 kWhite = kRgbToXyz * dvec3(1);

dvec3 rgb_to_ycxcz(const dvec3& rgb) {
  const dvec3 t = kRgbToXyz * rgb / kWhite;
  return {116 * t.y - 16, 500 * (t.x - t.y), 200 * (t.y - t.z)};
}

dvec3 ycxcz_to_rgb(const dvec3& c) {
  static const dmat3 xyz_to_rgb = glm::inverse(kRgbToXyz);
  const double y = (c.x + 16) / 116;
  return xyz_to_rgb * (dvec3(y + c.y / 500, y, y - c.z / 200) * kWhite);
}

// CIELab with the chroma scaled by lightness (the Hunt effect, 4.1.3).
dvec3 hunt_lab(const dvec3& rgb) {
  const dvec3 t = kRgbToXyz * rgb / kWhite;
  const auto f = [](double x) {
    constexpr double kDelta = 6.0 / 29;
    return x > kDelta * kDelta * kDelta ? std::cbrt(x) : x / (3 * kDelta * kDelta) + 4.0 / 29;
  };
  const double l = 116 * f(t.y) - 16;
  return {l, 0.01 * l * 500 * (f(t.x) - f(t.y)), 0.01 * l * 200 * (f(t.y) - f(t.z))};
}

double hyab(const dvec3& a, const dvec3& b) { return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z); }

// out(x,y) = sum over i,j of ky[j] kx[i] in(x+i, y+j), borders repeated.
Plane convolve(const Plane& in, int width, int height, const std::vector<double>& kx, const std::vector<double>& ky) {
  const int rx = int(kx.size()) / 2, ry = int(ky.size()) / 2;
  Plane rows(in.size()), out(in.size());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      double sum = 0;
      for (int i = -rx; i <= rx; ++i) sum += kx[i + rx] * in[size_t(y) * width + std::clamp(x + i, 0, width - 1)];
      rows[size_t(y) * width + x] = float(sum);
    }
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      double sum = 0;
      for (int j = -ry; j <= ry; ++j) sum += ky[j + ry] * rows[size_t(std::clamp(y + j, 0, height - 1)) * width + x];
      out[size_t(y) * width + x] = float(sum);
    }
  return out;
}

// Contrast sensitivity as a sum of Gaussians in space (4.1.1): a sqrt(pi/b) exp(-pi^2 r^2 / b), r in degrees. A
// Gaussian in the plane is a product of two on lines, so each term costs two passes.
struct Sensitivity {
  double a1, b1, a2, b2;
};
constexpr Sensitivity kAchromatic{1, 0.0047, 0, 1e-5}, kRedGreen{1, 0.0053, 0, 1e-5},
    kBlueYellow{34.1, 0.04, 13.5, 0.025};

std::vector<double> gaussian(double b, int radius, double pixels_per_degree) {
  std::vector<double> k(2 * radius + 1);
  for (int i = -radius; i <= radius; ++i) {
    const double r = i / pixels_per_degree;
    k[i + radius] = std::exp(-std::numbers::pi * std::numbers::pi * r * r / b);
  }
  return k;
}

Plane filter(const Plane& in, int width, int height, const Sensitivity& s, double pixels_per_degree) {
  const double widest = std::max({kAchromatic.b1, kRedGreen.b1, kBlueYellow.b1, kBlueYellow.b2});
  const int radius =
      int(std::ceil(3 * std::sqrt(widest / (2 * std::numbers::pi * std::numbers::pi)) * pixels_per_degree));
  Plane out(in.size(), 0);
  double total = 0;
  for (const auto& [a, b] : {std::pair{s.a1, s.b1}, std::pair{s.a2, s.b2}}) {
    if (a == 0) continue;
    const auto k = gaussian(b, radius, pixels_per_degree);
    double sum = 0;
    for (double w : k) sum += w;
    const double amplitude = a * std::sqrt(std::numbers::pi / b);
    total += amplitude * sum * sum;
    const Plane term = convolve(in, width, height, k, k);
    for (size_t i = 0; i < out.size(); ++i) out[i] += float(amplitude * term[i]);
  }
  for (float& v : out) v = float(v / total);
  return out;
}

std::array<Plane, 3> to_planes(const std::vector<float>& rgb) {
  std::array<Plane, 3> planes;
  for (auto& plane : planes) plane.resize(rgb.size() / 3);
  for (size_t i = 0; i < rgb.size() / 3; ++i) {
    const dvec3 c = rgb_to_ycxcz({rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2]});
    for (int k = 0; k < 3; ++k) planes[k][i] = float(c[k]);
  }
  return planes;
}

// What the eye passes of an image, in Hunt-adjusted Lab.
std::vector<dvec3> seen(const std::array<Plane, 3>& planes, int width, int height, double pixels_per_degree) {
  const Plane y = filter(planes[0], width, height, kAchromatic, pixels_per_degree);
  const Plane cx = filter(planes[1], width, height, kRedGreen, pixels_per_degree);
  const Plane cz = filter(planes[2], width, height, kBlueYellow, pixels_per_degree);
  std::vector<dvec3> lab(y.size());
  for (size_t i = 0; i < y.size(); ++i)
    lab[i] = hunt_lab(glm::clamp(ycxcz_to_rgb({y[i], cx[i], cz[i]}), dvec3(0), dvec3(1)));
  return lab;
}

// Sizes of the edge (first derivative) and point (second derivative) responses of the lightness (4.2.1).
void features(const Plane& y, int width, int height, double pixels_per_degree, Plane& edges, Plane& points) {
  const double sigma = 0.5 * 0.082 * pixels_per_degree;
  const int radius = int(std::ceil(3 * sigma));
  std::vector<double> smooth(2 * radius + 1), first(smooth), second(smooth);
  for (int i = -radius; i <= radius; ++i) {
    const double g = std::exp(-i * i / (2 * sigma * sigma));
    smooth[i + radius] = g;
    first[i + radius] = -i * g;
    second[i + radius] = (i * i / (sigma * sigma) - 1) * g;
  }
  const auto normalise = [](std::vector<double>& k) {  // positive and negative weights each sum to 1 in size
    double positive = 0, negative = 0;
    for (double w : k) (w > 0 ? positive : negative) += std::abs(w);
    for (double& w : k) w /= w > 0 ? positive : negative;
  };
  normalise(first), normalise(second), normalise(smooth);
  Plane unit(y.size());
  for (size_t i = 0; i < y.size(); ++i) unit[i] = (y[i] + 16) / 116;
  const auto size = [&](const std::vector<double>& k) {
    const Plane dx = convolve(unit, width, height, k, smooth), dy = convolve(unit, width, height, smooth, k);
    Plane out(dx.size());
    for (size_t i = 0; i < out.size(); ++i) out[i] = std::hypot(dx[i], dy[i]);
    return out;
  };
  edges = size(first);
  points = size(second);
}

}  // namespace

std::vector<float> flip_map(const std::vector<float>& a, const std::vector<float>& b, int width, int height,
                            double pixels_per_degree) {
  const auto planes_a = to_planes(a), planes_b = to_planes(b);
  const auto lab_a = seen(planes_a, width, height, pixels_per_degree);
  const auto lab_b = seen(planes_b, width, height, pixels_per_degree);
  Plane edges_a, edges_b, points_a, points_b;
  features(planes_a[0], width, height, pixels_per_degree, edges_a, points_a);
  features(planes_b[0], width, height, pixels_per_degree, edges_b, points_b);

  // Colour differences to the power 0.7 up to the largest possible one, redistributed so that 40 % of it takes 95 % of
  // the range (4.1.4); then sharpened where the features differ (4.3).
  constexpr double kPower = 0.7, kKnee = 0.4, kKneeValue = 0.95;
  const double largest = std::pow(hyab(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1})), kPower);
  std::vector<float> map(lab_a.size());
  for (size_t i = 0; i < map.size(); ++i) {
    const double d = std::pow(hyab(lab_a[i], lab_b[i]), kPower), knee = kKnee * largest;
    const double color =
        d < knee ? kKneeValue / knee * d : kKneeValue + (d - knee) / (largest - knee) * (1 - kKneeValue);
    const double feature = std::sqrt(std::max(std::abs(edges_a[i] - edges_b[i]), std::abs(points_a[i] - points_b[i])) /
                                     std::numbers::sqrt2);
    map[i] = float(std::pow(std::clamp(color, 0.0, 1.0), 1 - std::min(feature, 1.0)));
  }
  return map;
}

}  // namespace wale
