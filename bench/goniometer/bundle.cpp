#include "bench/goniometer/bundle.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wale {
namespace {

constexpr double kSlabAngle = 0.15;  // radians of twist per slab
constexpr double kInfinity = std::numeric_limits<double>::infinity();

dvec3 turned(dvec3 v, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * v.x - s * v.y, s * v.x + c * v.y, v.z};
}

}  // namespace

Bundle::Bundle(const FibreRecipe& recipe) {
  const FibreSection section = make_fibre_section(recipe);
  radius_ = section.fibre_radius;
  const bool twisted = recipe.twist != 0;
  angle_ = twisted ? std::copysign(kSlabAngle, recipe.twist) : 0;
  slab_ = twisted ? angle_ / recipe.twist : kInfinity;
  for (const auto& f : section.fibres) {
    const dvec3 middle(f.distance * std::cos(f.angle), f.distance * std::sin(f.angle), 0);
    if (!twisted) {
      pieces_.push_back({middle, {0, 0, 1}});
      continue;
    }
    const dvec3 low = turned(middle, -angle_ / 2) - dvec3(0, 0, slab_ / 2);
    const dvec3 high = turned(middle, angle_ / 2) + dvec3(0, 0, slab_ / 2);
    pieces_.push_back({0.5 * (low + high), glm::normalize(high - low)});
  }
  build_grid();
}

void Bundle::build_grid() {
  cells_ = std::clamp(int(1 / radius_), 1, 64);
  std::vector<std::vector<int>> cells(size_t(cells_) * cells_);
  const auto cell = [&](double x) { return std::clamp(int((x + 1) / 2 * cells_), 0, cells_ - 1); };
  for (int k = 0; k < fibres(); ++k) {
    const Piece& p = pieces_[size_t(k)];
    const double half = std::isfinite(slab_) ? 0.5 * slab_ / p.axis.z : 0;
    // A tilted cylinder reaches a little past its axis' end in the slab.
    const double reach = radius_ * (1 + std::hypot(p.axis.x, p.axis.y) / p.axis.z) + 1e-9;
    const double dx = std::abs(p.axis.x) * half + reach, dy = std::abs(p.axis.y) * half + reach;
    for (int j = cell(p.centre.y - dy); j <= cell(p.centre.y + dy); ++j)
      for (int i = cell(p.centre.x - dx); i <= cell(p.centre.x + dx); ++i) cells[size_t(j) * cells_ + i].push_back(k);
  }
  first_.push_back(0);
  for (const auto& c : cells) {
    list_.insert(list_.end(), c.begin(), c.end());
    first_.push_back(int(list_.size()));
  }
}

/// Distance to where the ray enters the piece's cylinder from outside, ahead of its origin; infinity if it does not.
double Bundle::entry(const Piece& piece, const Ray& ray) const {
  const dvec3 w = ray.origin - piece.centre, k = glm::cross(piece.axis, ray.direction);
  const double a = glm::dot(k, k);
  if (a < 1e-12) return kInfinity;
  const double l2 = glm::dot(w, k) * glm::dot(w, k) / a, d = radius_ * radius_ - l2;
  if (d <= 0) return kInfinity;
  const double foot = (glm::dot(piece.axis, w) * glm::dot(piece.axis, ray.direction) - glm::dot(w, ray.direction)) / a;
  const double t = foot - std::sqrt(d / a);
  return t > 0 ? t : kInfinity;
}

Bundle::Hit Bundle::nearest(const Ray& ray, double limit, int ignored) const {
  Hit best{-1, limit};
  const double size = 2.0 / cells_;
  const dvec3 o = ray.origin, d = ray.direction;
  int i = std::clamp(int((o.x + 1) / size), 0, cells_ - 1), j = std::clamp(int((o.y + 1) / size), 0, cells_ - 1);
  const int di = d.x > 0 ? 1 : -1, dj = d.y > 0 ? 1 : -1;
  const double step_x = d.x != 0 ? size / std::abs(d.x) : kInfinity,
               step_y = d.y != 0 ? size / std::abs(d.y) : kInfinity;
  double next_x = d.x != 0 ? ((i + (di > 0)) * size - 1 - o.x) / d.x : kInfinity;
  double next_y = d.y != 0 ? ((j + (dj > 0)) * size - 1 - o.y) / d.y : kInfinity;
  for (;;) {
    const size_t c = size_t(j) * cells_ + i;
    for (int n = first_[c]; n < first_[c + 1]; ++n) {
      const int k = list_[size_t(n)];
      if (k == ignored) continue;
      const double t = entry(pieces_[size_t(k)], ray);
      if (t < best.t) best = {k, t};
    }
    const double leave = std::min(next_x, next_y);
    if (best.t <= leave) return best;
    if (next_x < next_y)
      i += di, next_x += step_x;
    else
      j += dj, next_y += step_y;
    if (i < 0 || j < 0 || i >= cells_ || j >= cells_) return best;
  }
}

int Bundle::advance(Ray& ray, int ignored) const {
  for (;;) {
    const dvec3 o = ray.origin, d = ray.direction;
    // Out of the unit cylinder.
    const double a = d.x * d.x + d.y * d.y, b = o.x * d.x + o.y * d.y, c = o.x * o.x + o.y * o.y - 1;
    const double out = a > 1e-18 ? (-b + std::sqrt(std::max(0.0, b * b - a * c))) / a : kInfinity;
    double edge = kInfinity;
    if (std::isfinite(slab_) && d.z != 0) edge = std::max(0.0, (std::copysign(slab_ / 2, d.z) - o.z) / d.z);
    const double limit = std::min(out, edge);
    const Hit hit = nearest(ray, limit, ignored);
    if (hit.fibre >= 0) {
      const Piece& p = pieces_[size_t(hit.fibre)];
      const dvec3 w = o - p.centre;
      const double da = glm::dot(d, p.axis), denominator = 1 - da * da;
      const double along = (glm::dot(w, p.axis) - da * glm::dot(w, d)) / denominator;
      ray.origin = p.centre + along * p.axis;
      return hit.fibre;
    }
    if (!(edge < out)) {
      if (!std::isfinite(out)) return -1;  // along the axis between fibres: leaves at the far end
      ray.origin += out * d;
      return -1;
    }
    const double sign = d.z > 0 ? 1 : -1;
    ray.origin = turned(o + edge * d, -sign * angle_);
    ray.origin.z = -sign * slab_ / 2;
    ray.direction = turned(d, -sign * angle_);
    ray.turn += sign * angle_;
  }
}

}  // namespace wale
