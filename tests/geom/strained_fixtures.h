#pragma once
#include <cmath>
#include <functional>
#include <numbers>

#include "geom/base_mesh_generators.h"
#include "geom/fabric.h"
#include "geom/lattice_fabric.h"
#include "geom/strain_field.h"
#include "geom/warp.h"
#include "tests/geom/tile_fixtures.h"

namespace wale::test {

/// Bundled stockinette whose points move by strain * reach * (a smooth vector along the yarn): a table without noise.
inline Pattern straining_tile(double reach) {
  Pattern tile = stockinette_pattern(0.002);
  StrainTable& table = tile.strains;
  table.course = {-0.2, 0, 0.5};
  table.wale = {-0.1, 0, 0.4};
  for (const double b : table.wale)
    for (const double a : table.course) {
      auto& shape = table.offsets.emplace_back();
      for (const PatternCurve& curve : tile.curves)
        for (size_t i = 0; i < curve.points.size(); ++i) {  // the last point is the first one of the next tile
          const double t = 2 * std::numbers::pi * double(i) / double(curve.points.size() - 1);
          shape.push_back(reach * (a * dvec3(std::sin(2 * t), std::cos(t), 0.3 * std::sin(t)) +
                                   b * dvec3(std::sin(t), 0.5 * std::sin(2 * t), std::cos(t))));
        }
    }
  return tile;
}

/// Number of points of a tile's curves.
inline size_t point_count(const Pattern& tile) {
  size_t points = 0;
  for (const PatternCurve& curve : tile.curves) points += curve.points.size();
  return points;
}

inline FabricSpec strained_spec(LoopStrain strain, int plies = 3) {
  FabricSpec spec;
  spec.name = "cloth";
  spec.scale.kind = FabricScale::Kind::uv_metres;
  spec.plies = plies;
  spec.strain = strain;
  return spec;
}

inline BaseMesh moved(BaseMesh mesh, const std::function<dvec3(dvec3)>& move) {
  for (dvec3& p : mesh.position) p = move(p);
  compute_normals(mesh);
  return mesh;
}

/// A vertex of a fabric where the base mesh carries it, metres.
inline dvec3 place(const Fabric& fabric, size_t vertex) {
  const Anchor& a = fabric.anchors[vertex];
  return warp_point(fabric.mesh, {a.triangle, a.b1, a.b2, 0}, a.height);
}

inline bool same_bits(const Anchor& a, const Anchor& b) {
  return a.triangle == b.triangle && a.b1 == b.b1 && a.b2 == b.b2 && a.height == b.height && a.nx == b.nx &&
         a.ny == b.ny && a.nz == b.nz && a.length == b.length;
}

inline void expect_same_bits(const Fabric& a, const Fabric& b) {
  ASSERT_EQ(a.anchors.size(), b.anchors.size());
  size_t different = 0;
  for (size_t i = 0; i < a.anchors.size(); ++i) different += !same_bits(a.anchors[i], b.anchors[i]);
  EXPECT_EQ(different, 0u);
}

}  // namespace wale::test
