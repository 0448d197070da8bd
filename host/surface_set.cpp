#include "host/surface_set.h"

#include <bit>

#include "host/materials.h"

namespace wale {

int SurfaceSet::add_material(World& world, const SurfaceAppearance& look) {
  WSurfaceMaterial m = surface_material(look);
  m.emission = {0, 0, 0, 0};
  m.light = -1;
  world.surface_materials.push_back(m);
  return int(world.surface_materials.size()) - 1;
}

int SurfaceSet::add_emitter(World& world, const Rgb& radiance, bool one_sided) {
  SurfaceAppearance black;
  black.color = {0, 0, 0};
  const int index = add_material(world, black);
  world.surface_materials[size_t(index)].emission = {float(radiance[0]), float(radiance[1]), float(radiance[2]),
                                                     one_sided ? 1.0f : 0.0f};
  return index;
}

void SurfaceSet::add_mesh(const BaseMesh& mesh, int material) {
  for (const auto& t : mesh.triangle) {
    Triangle triangle;
    for (size_t k = 0; k < 3; ++k) {
      triangle.corner[k] = mesh.position[t[k]];
      triangle.normal[k] = mesh.normal[t[k]];
    }
    triangle.material = material;
    triangles_.push_back(triangle);
  }
}

void SurfaceSet::add_quad(const dvec3& centre, const dvec3& half_u, const dvec3& half_v, int material) {
  const dvec3 n = glm::normalize(glm::cross(half_u, half_v));
  const std::array<dvec3, 4> c = {centre - half_u - half_v, centre + half_u - half_v, centre + half_u + half_v,
                                  centre - half_u + half_v};
  triangles_.push_back({{c[0], c[1], c[2]}, {n, n, n}, material});
  triangles_.push_back({{c[0], c[2], c[3]}, {n, n, n}, material});
}

void SurfaceSet::add_sphere(const dvec3& centre, double radius, int material, int light) {
  spheres_.push_back({centre, radius, material, light});
}

void SurfaceSet::place(World& world) const {
  for (const Triangle& t : triangles_) {
    for (const auto& c : t.corner)
      for (int a = 0; a < 3; ++a) world.triangles.push_back(float(c[a] - world.origin[a]));
    for (const auto& n : t.normal)
      for (int a = 0; a < 3; ++a) world.triangles.push_back(float(n[a]));
    world.triangles.push_back(std::bit_cast<float>(uint32_t(t.material)));
    world.triangles.push_back(0.0f);
  }
  for (const Sphere& s : spheres_) {
    const dvec3 c = s.centre - world.origin;
    world.spheres.push_back({{float(c.x), float(c.y), float(c.z), float(s.radius)}, s.material, s.light, 0, 0});
  }
}

}  // namespace wale
