#include "host/cost/ply_surface_distance.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "host/scene_device.h"
#include "host/world.h"

namespace wale::cost {
namespace {

constexpr double kFar = 1e300;
// Places farther from every ply than this are looked up among all segments: there are hardly any.
constexpr double kReachRadii = 3;

dvec3 unit_or(const dvec3& v, const dvec3& otherwise) {
  const double l = glm::length(v);
  return l > 0 ? v / l : otherwise;
}

}  // namespace

PlySurface::PlySurface(std::vector<Curve> curves) {
  double reach = 0;
  for (const Curve& curve : curves) {
    const std::vector<dvec3>& p = curve.points;
    const size_t skip = curve.ghost_ends ? 1 : 0;
    for (size_t i = skip; i + 1 + skip < p.size(); ++i) {
      const dvec3 along = unit_or(p[i + 1] - p[i], {1, 0, 0});
      const dvec3 before = i > 0 ? unit_or(p[i] - p[i - 1], along) : along;
      const dvec3 after = i + 2 < p.size() ? unit_or(p[i + 2] - p[i + 1], along) : along;
      segments_.push_back({p[i], p[i + 1], before + along, along + after, curve.radius});
      reach = std::max(reach, 0.5 * glm::length(p[i + 1] - p[i]) + kReachRadii * curve.radius);
    }
  }
  for (const Curve& curve : curves)
    if (!curve.ghost_ends && !curve.points.empty()) {
      ends_.push_back(curve.points.front()), ends_.push_back(curve.points.back());
      end_reach_ = std::max(end_reach_, kEndRadii * curve.radius);
    }
  if (end_reach_ > 0) near_ends_.emplace(end_reach_);
  for (size_t i = 0; i < ends_.size(); ++i) near_ends_->add(ends_[i], int(i));
  if (!(reach > 0)) return;
  middles_.emplace(reach);
  for (size_t i = 0; i < segments_.size(); ++i) middles_->add(0.5 * (segments_[i].start + segments_[i].end), int(i));
}

double PlySurface::radii_from(const dvec3& place, const Segment& s, bool joints) const {
  const dvec3 from_start = place - s.start, from_end = place - s.end;
  if (!joints) {
    if (glm::dot(from_start, s.start_plane) < 0 || glm::dot(from_end, s.end_plane) > 0) return kFar;
    const dvec3 along = unit_or(s.end - s.start, {1, 0, 0});
    return std::abs(glm::length(from_start - along * glm::dot(from_start, along)) - s.radius) / s.radius;
  }
  return std::min(std::abs(glm::length(from_start) - s.radius), std::abs(glm::length(from_end) - s.radius)) / s.radius;
}

double PlySurface::among(const dvec3& place, std::span<const int> numbers) const {
  for (const bool joints : {false, true}) {
    double least = kFar;
    for (const int i : numbers) least = std::min(least, radii_from(place, segments_[size_t(i)], joints));
    if (least < kFar) return least;
  }
  return kFar;
}

double PlySurface::radii_from(const dvec3& place) const {
  std::vector<int> numbers;
  if (middles_) middles_->visit_near(place, [&](int i) { numbers.push_back(i); });
  if (const double near = among(place, numbers); near < kReachRadii - 1) return near;
  numbers.resize(segments_.size());
  std::iota(numbers.begin(), numbers.end(), 0);
  return among(place, numbers);
}

bool PlySurface::near_open_end(const dvec3& place) const {
  bool near = false;
  if (near_ends_)
    near_ends_->visit_near(place, [&](int i) { near |= glm::length(ends_[size_t(i)] - place) < end_reach_; });
  return near;
}

std::optional<PlySurface> ply_surface_of(const Device& device, const World& world) {
  for (const Fabric& fabric : world.fabrics)
    if (!fabric.lattice.empty()) return {};
  if (world.fabrics.empty()) return {};
  const std::vector<float> points = FabricWarp(device, fabric_inputs(world), world.origin).points().read(device);
  std::vector<PlySurface::Curve> curves;
  size_t first = 0;  // vertices of the fabrics follow one another
  for (const Fabric& fabric : world.fabrics) {
    for (const PlyRun& run : fabric.runs)
      for (uint32_t number = 0; number < run.plies; ++number) {
        PlySurface::Curve curve{{}, run.radius, run.ghost_ends};
        for (uint32_t k = 0; k < run.count; ++k) {
          const float* v = &points[(first + run.first_vertex + size_t(number) * run.count + k) * 3];
          curve.points.push_back(world.origin + dvec3(v[0], v[1], v[2]));
        }
        curves.push_back(std::move(curve));
      }
    first += fabric.anchors.size();
  }
  return PlySurface(std::move(curves));
}

}  // namespace wale::cost
