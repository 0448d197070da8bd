#include "host/serve/control_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/materials.h"
#include "host/schema.h"
#include "host/thick_layer.h"

namespace wale {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

struct Axes {
  dvec3 front, side, up;
  explicit Axes(const dvec3& up_axis) : front(0), side(0), up(glm::normalize(up_axis)) {
    const dvec3 hint = std::abs(up.z) > 0.9 ? dvec3(0, -1, 0) : dvec3(0, 0, 1);
    side = glm::normalize(glm::cross(up, hint));
    front = glm::cross(side, up);
  }
};

}  // namespace

std::string hex_color(const Rgb& linear) {
  std::string out = "#";
  for (const double v : linear)
    out += fmt::format("{:02x}", int(std::lround(255 * linear_to_srgb(std::clamp(v, 0.0, 1.0)))));
  return out;
}

std::string plain_number(double value) { return fmt::format("{:.7g}", value); }

std::string point_text(const dvec3& p, double unit) {
  return fmt::format("[{},{},{}]", plain_number(p.x / unit), plain_number(p.y / unit), plain_number(p.z / unit));
}

Rgb shown_color(const PlyAppearance& yarn) {
  if (yarn.color) return *yarn.color;
  if (yarn.back) return *yarn.back;
  const WPlyMaterial made = ply_material(yarn);
  PlyAppearance white = yarn;
  white.color = white.fibre_color = std::nullopt;
  return ThickLayer(ply_material(white)).seen(Rgb{made.fibre.x, made.fibre.y, made.fibre.z});
}

LightAngles light_angles(const dvec3& from_target, const dvec3& up) {
  const Axes axes(up);
  const dvec3 d = glm::normalize(from_target);
  return {std::atan2(glm::dot(d, axes.side), glm::dot(d, axes.front)) / kDegree,
          std::asin(std::clamp(glm::dot(d, axes.up), -1.0, 1.0)) / kDegree};
}

dvec3 light_direction(const LightAngles& angles, const dvec3& up) {
  const Axes axes(up);
  const double a = angles.around * kDegree, e = angles.above * kDegree;
  return std::cos(e) * (std::cos(a) * axes.front + std::sin(a) * axes.side) + std::sin(e) * axes.up;
}

}  // namespace wale
