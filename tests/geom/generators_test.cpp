// Bundled base meshes: sizes as asked, normals outwards, UVs in metres, sheets that meet.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "geom/base_mesh_generators.h"
#include "geom/charts.h"
#include "geom/error.h"
#include "geom/mesh_edges.h"

namespace wale {
namespace {

/// Every triangle looks the way its vertex normals point, and UV runs counter-clockwise seen from there.
void expect_consistent(const BaseMesh& mesh) {
  const MeshReport report = validate(mesh);
  EXPECT_EQ(report.non_manifold_edges, 0u);
  EXPECT_EQ(report.degenerate_triangles, 0u);
  EXPECT_EQ(report.zero_area_uv, 0u);
  EXPECT_EQ(report.flipped_uv, 0u);
  EXPECT_EQ(report.overlap, 0);
  for (size_t i = 0; i < mesh.triangle.size(); ++i) {
    const auto& t = mesh.triangle[i];
    const dvec3 face = glm::cross(mesh.position[t[1]] - mesh.position[t[0]], mesh.position[t[2]] - mesh.position[t[0]]);
    EXPECT_GT(glm::dot(face, mesh.normal[t[0]] + mesh.normal[t[1]] + mesh.normal[t[2]]), 0);
    EXPECT_GT(uv_area2(mesh.uv[i]), 0);
  }
  for (const dvec3& n : mesh.normal) EXPECT_NEAR(glm::length(n), 1, 1e-12);
}

TEST(Generators, Swatch) {
  const BaseMesh mesh = make_swatch(0.3, 0.2, 6, 4);
  expect_consistent(mesh);
  EXPECT_EQ(mesh.triangle.size(), 48u);
  EXPECT_EQ(mesh.position.front(), dvec3(-0.15, -0.1, 0));
  EXPECT_EQ(validate(mesh).boundary_edges, 20u);
}

TEST(Generators, TubeNormalsPointOutwards) {
  const BaseMesh mesh = make_tube(0.1, 0.3, 64, 5);
  expect_consistent(mesh);
  EXPECT_EQ(validate(mesh).boundary_edges, 128u);
  for (size_t v = 0; v < mesh.position.size(); ++v) {
    const dvec3 out = mesh.position[v] * dvec3(10, 10, 0);
    EXPECT_NEAR(glm::length(out), 1, 1e-12);
    EXPECT_GT(glm::dot(out, mesh.normal[v]), 0.999);
  }
  EXPECT_NEAR(validate(mesh).stretch_median.x, 1, 1e-3);
}

TEST(Generators, PillowIsClosedWithTwoChartsAndRoundEdges) {
  const BaseMesh mesh = make_pillow(0.4, 0.3, 0.1, 40, 36);
  expect_consistent(mesh);
  const MeshReport report = validate(mesh);
  EXPECT_EQ(report.boundary_edges, 0u);
  EXPECT_EQ(report.seam_edges, 2u * (40 + 36));
  EXPECT_EQ(find_charts(mesh).size(), 2u);
  dvec3 hi(0);
  for (const dvec3& p : mesh.position) hi = glm::max(hi, p);
  EXPECT_NEAR(hi.z, 0.05, 1e-12);
  // Halfway along a border the two sheets meet almost upright.
  for (size_t v = 0; v < mesh.position.size(); ++v)
    if (mesh.position[v].z == 0 && mesh.position[v].x > 0.199 && std::abs(mesh.position[v].y) < 1e-9) {
      EXPECT_GT(mesh.normal[v].x, 0.999);
    }
  EXPECT_NEAR(report.stretch_median.x, 1.1, 0.1);
}

TEST(Generators, BeanieIsClosedAboveAndOpenBelow) {
  const BaseMesh mesh = make_beanie(0.09, 0.22, 64, 60);
  expect_consistent(mesh);
  const MeshReport report = validate(mesh);
  EXPECT_EQ(report.boundary_edges, 64u);
  const auto charts = find_charts(mesh);
  EXPECT_EQ(charts.size(), 2u);
  dvec3 lo(1), hi(-1);
  for (const dvec3& p : mesh.position) {
    lo = glm::min(lo, p);
    hi = glm::max(hi, p);
  }
  EXPECT_NEAR(hi.z, 0.22, 1e-9);
  EXPECT_NEAR(lo.z, 0, 1e-9);
  EXPECT_NEAR(hi.x, 0.09 * 1.06, 0.002);
}

TEST(Generators, SockIsClosedAtTheToeAndOpenAtTheCuff) {
  const BaseMesh mesh = make_sock(0.04, 0.2, 0.22, 64, 80);
  expect_consistent(mesh);
  const MeshReport report = validate(mesh);
  EXPECT_EQ(report.boundary_edges, 64u);
  EXPECT_EQ(find_charts(mesh).size(), 2u);
  EXPECT_LT(report.stretch_median.y, 1.1);
  dvec3 lo(1), hi(-1);
  double enclosed = 0;
  for (const auto& t : mesh.triangle) {
    const dvec3 a = mesh.position[t[0]], b = mesh.position[t[1]], c = mesh.position[t[2]];
    enclosed += glm::dot(a - dvec3(0, 0, 0.2), glm::cross(b - a, c - a)) / 6;  // the cuff's plane adds nothing
    for (const dvec3& p : {a, b, c}) lo = glm::min(lo, p), hi = glm::max(hi, p);
  }
  EXPECT_NEAR(hi.z, 0.2, 1e-12);
  EXPECT_NEAR(hi.x, 0.22, 1e-12);
  EXPECT_NEAR(hi.y, 0.044, 1e-3);
  EXPECT_GT(enclosed, 0.9e-3);  // faces look outwards; a tube of leg and foot holds 0.0016 m^3
  EXPECT_LT(enclosed, 2e-3);
}

TEST(Generators, DrapedSquareKeepsItsGapToTheSphere) {
  for (const double size : {0.3, 0.6, 1.0}) {
    const double radius = 0.15;
    const BaseMesh mesh = make_draped_square(size, radius, 120);
    expect_consistent(mesh);
    for (const auto& t : mesh.triangle) {
      // Nearest a flat triangle can come is its centre or an edge's middle, for triangles this small.
      const dvec3 a = mesh.position[t[0]], b = mesh.position[t[1]], c = mesh.position[t[2]];
      for (const dvec3& p : {(a + b + c) / 3.0, (a + b) / 2.0, (b + c) / 2.0, (c + a) / 2.0})
        EXPECT_GT(glm::length(p), 1.01 * radius);
    }
    EXPECT_EQ(find_charts(mesh).size(), 1u);
    EXPECT_EQ(validate(mesh).boundary_edges, 480u);
  }
}

TEST(Generators, SizesOutOfRangeAreRefused) {
  EXPECT_THROW(make_swatch(0, 1, 2, 2), Error);
  EXPECT_THROW(make_swatch(1, NAN, 2, 2), Error);
  EXPECT_THROW(make_tube(1, 1, 2, 2), Error);
  EXPECT_THROW(make_beanie(1, 1, 8, 1), Error);
  EXPECT_THROW(make_sock(0.04, 0.05, 0.22, 64, 80), Error);
  EXPECT_THROW(make_draped_square(1, 1, 100000), Error);
}

}  // namespace
}  // namespace wale
