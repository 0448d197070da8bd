#pragma once
#include <array>
#include <vector>

#include "host/world.h"

namespace wale {

/// Triangles and spheres of objects and lights with their materials, in double until the world's origin is known.
class SurfaceSet {
 public:
  struct Triangle {
    std::array<dvec3, 3> corner, normal;
    int material;
  };

  /// Each adds a material to the world and returns its number.
  static int add_material(World& world, const SurfaceAppearance& look);
  static int add_emitter(World& world, const Rgb& radiance, bool one_sided);

  void add_mesh(const BaseMesh& mesh, int material);
  /// Its front face is where half_u x half_v points.
  void add_quad(const dvec3& centre, const dvec3& half_u, const dvec3& half_v, int material);
  /// `light`: its number, or -1.
  void add_sphere(const dvec3& centre, double radius, int material, int light);

  const std::vector<Triangle>& triangles() const { return triangles_; }

  /// Writes them into the world, relative to its origin.
  void place(World& world) const;

 private:
  struct Sphere {
    dvec3 centre;
    double radius;
    int material, light;
  };

  std::vector<Triangle> triangles_;
  std::vector<Sphere> spheres_;
};

}  // namespace wale
