#include <algorithm>
#include <bit>
#include <cmath>

#include "host/analysis.h"

namespace wale {
namespace {

// Share of the scene's size by which all must lie clear of a plane or a ball: far more than floats round.
constexpr double kClear = 1e-5;

dvec3 vec(const w_float4& v) { return {v.x, v.y, v.z}; }

dvec3 corner(const World& world, size_t light_triangle, size_t k) {
  const float* v = &world.lights.triangles[9 * light_triangle + 3 * k];
  return {v[0], v[1], v[2]};
}

bool shines(const World& world, uint32_t material) { return world.surface_materials[material].light >= 0; }

/// Corners of the triangles that are no lights; relative to the origin, as all of what follows.
template <typename Visit>
void for_each_corner(const World& world, const Visit& visit) {
  for (size_t i = 0; i < world.triangle_count(); ++i) {
    const float* v = &world.triangles[i * World::kTriangleWords];
    if (shines(world, std::bit_cast<uint32_t>(v[18]))) continue;
    for (size_t k = 0; k < 3; ++k) visit(dvec3(v[3 * k], v[3 * k + 1], v[3 * k + 2]));
  }
}

/// Radius of a ball about the camera's place that all its rays start in.
double camera_radius(const WCamera& c) {
  // The film's filter reaches one pixel beyond the picture.
  const double wider = 1 + 2.0 / std::min(c.width, c.height);
  return c.kind == 1 ? wider * std::hypot(c.half_width, c.half_height) : double(c.aperture);
}

}  // namespace

std::optional<std::string> is_black(const World& world, size_t light) {
  if (world.lights.power[light] > 0) return {};
  return "it is black";
}

std::optional<std::string> shines_away(const World& world, size_t light, const std::vector<PlyReach>& reach) {
  const WLight& l = world.lights.lights[light];
  if (l.kind != W_LIGHT_MESH || l.center.w == 0) return {};
  // One side of a mesh is a half space only where the mesh is flat: triangle by triangle.
  double size = camera_radius(world.camera) + glm::length(vec(world.camera.origin));
  for_each_corner(world, [&](const dvec3& p) { size = std::max(size, glm::length(p)); });
  for (size_t t = l.first_triangle; t < l.first_triangle + l.triangles; ++t) {
    const dvec3 a = corner(world, t, 0), normal = glm::cross(corner(world, t, 1) - a, corner(world, t, 2) - a);
    if (!(glm::length(normal) > 0)) continue;
    const dvec3 n = glm::normalize(normal);
    const double plane = glm::dot(n, a) - kClear * (size + glm::length(a));
    double front = glm::dot(n, vec(world.camera.origin)) + camera_radius(world.camera);
    for_each_corner(world, [&](const dvec3& p) { front = std::max(front, glm::dot(n, p)); });
    for (const WSphere& s : world.spheres)
      if (s.light < 0) front = std::max(front, glm::dot(n, vec(s.center)) + double(s.center.w));
    for (const PlyReach& fabric : reach) {
      if (front > plane) break;
      front = std::max(front, fabric.along(n) - glm::dot(n, world.origin));
    }
    if (front > plane) return {};
  }
  return "it shines one way only, and everything that scatters and the camera are on its other side";
}

std::optional<std::string> is_enclosed(const World& world, size_t light, const std::vector<PlyReach>& reach) {
  const WLight& l = world.lights.lights[light];
  if (l.kind == W_LIGHT_ENVIRONMENT) return {};
  for (const WSphere& ball : world.spheres) {
    if (ball.light >= 0) continue;
    const dvec3 centre = vec(ball.center);
    const double radius = ball.center.w, clear = kClear * (radius + glm::length(centre));
    double farthest = 0;
    if (l.kind == W_LIGHT_SPHERE)
      farthest = glm::length(vec(l.center) - centre) + double(l.center.w);
    else
      for (size_t t = l.first_triangle; t < l.first_triangle + l.triangles; ++t)
        for (size_t k = 0; k < 3; ++k) farthest = std::max(farthest, glm::length(corner(world, t, k) - centre));
    if (farthest > radius - clear) continue;
    double nearest = glm::length(vec(world.camera.origin) - centre) - camera_radius(world.camera);
    for (const PlyReach& fabric : reach) nearest = std::min(nearest, fabric.distance(centre + world.origin));
    if (nearest > radius + clear) return "an opaque sphere encloses it";
  }
  return {};
}

}  // namespace wale
