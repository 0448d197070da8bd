#include "geom/mesh_repair.h"

#include <gtest/gtest.h>

namespace wale {
namespace {

/// Triangles with three vertices of their own each: corner k of triangle t is vertex 3 t + k.
BaseMesh soup(const std::vector<std::array<dvec3, 3>>& triangles, const std::vector<std::array<dvec2, 3>>& uv) {
  BaseMesh mesh;
  for (uint32_t t = 0; t < triangles.size(); ++t) {
    for (const dvec3& p : triangles[t]) mesh.position.push_back(p);
    mesh.triangle.push_back({3 * t, 3 * t + 1, 3 * t + 2});
    mesh.uv.push_back(uv[t]);
  }
  compute_normals(mesh);
  return mesh;
}

constexpr dvec3 kA(0, 0, 0), kB(1, 0, 0), kC(1, 0, 1), kD(0, 0, 1);  // a square in the plane y = 0

TEST(MeshRepair, LooseTrianglesOfASheetAreJoined) {
  BaseMesh mesh = soup({{kA, kB, kC}, {kA, kC, kD}},
                       {{dvec2(0, 0), dvec2(1, 0), dvec2(1, 1)}, {dvec2(0, 0), dvec2(1, 1), dvec2(0, 1)}});
  EXPECT_EQ(join_duplicate_vertices(mesh), 2u);
  EXPECT_EQ(mesh.triangle[1][0], mesh.triangle[0][0]);
  EXPECT_EQ(mesh.triangle[1][1], mesh.triangle[0][2]);
}

// Front and back of one sheet, wound against each other, with UVs of their own: joined, their normals would cancel.
TEST(MeshRepair, LayersOfADoubledSheetStayApart) {
  BaseMesh mesh = soup({{kA, kB, kC}, {kA, kC, kB}},
                       {{dvec2(0, 0), dvec2(1, 0), dvec2(1, 1)}, {dvec2(5, 0), dvec2(6, 1), dvec2(6, 0)}});
  EXPECT_EQ(join_duplicate_vertices(mesh), 0u);
  for (const uint32_t v : mesh.triangle[0]) EXPECT_NEAR(glm::dot(mesh.normal[v], dvec3(0, -1, 0)), 1, 1e-12);
  for (const uint32_t v : mesh.triangle[1]) EXPECT_NEAR(glm::dot(mesh.normal[v], dvec3(0, 1, 0)), 1, 1e-12);
}

// Two charts wound against each other over a seam with shared vertices: each side keeps its own normals.
TEST(MeshRepair, OpposedSeamsGetVerticesOfTheirOwn) {
  BaseMesh mesh;
  mesh.position = {kA, kB, kC, kD};
  mesh.triangle = {{0, 1, 2}, {0, 3, 2}};  // the second runs the other way round
  mesh.uv = {{dvec2(0, 0), dvec2(1, 0), dvec2(1, 1)}, {dvec2(5, 0), dvec2(5, 1), dvec2(6, 1)}};
  compute_normals(mesh);
  EXPECT_EQ(part_opposed_seams(mesh), 2u);
  for (size_t t = 0; t < 2; ++t)
    for (const uint32_t v : mesh.triangle[t])
      EXPECT_NEAR(glm::dot(mesh.normal[v], dvec3(0, t == 0 ? -1 : 1, 0)), 1, 1e-12) << t;
}

}  // namespace
}  // namespace wale
