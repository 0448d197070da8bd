// The warp against the identity and against analytic surfaces, its Jacobian against differences.
#include "geom/warp.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "geom/base_mesh_generators.h"
#include "geom/mesh_edges.h"

namespace wale {
namespace {

TEST(Warp, IdentityOnAFlatMeshWhoseUvIsItsPosition) {
  BaseMesh mesh = make_swatch(2, 2, 5, 5);
  for (size_t t = 0; t < mesh.triangle.size(); ++t)
    for (size_t c = 0; c < 3; ++c) mesh.uv[t][c] = dvec2(mesh.position[mesh.triangle[t][c]]);
  const auto charts = find_charts(mesh);
  const ChartLocator locator(mesh, charts[0]);
  for (double x = -0.95; x < 1; x += 0.17)
    for (double y = -0.95; y < 1; y += 0.19) {
      ChartPoint at;
      ASSERT_TRUE(locator.locate({x, y}, 0, {1, 1}, at));
      EXPECT_LT(glm::length(warp_point(mesh, at, 0.3) - dvec3(x, y, 0.3)), 1e-14);
      const dmat3 j = warp_jacobian(mesh, at, 0.3, {1, 1});
      for (int c = 0; c < 3; ++c) EXPECT_LT(glm::length(j[c] - dmat3(1)[c]), 1e-13);
    }
  ChartPoint outside;  // linear extrapolation is exact here
  ASSERT_TRUE(locator.locate({1.2, 0.1}, 0.3, {1, 1}, outside));
  EXPECT_LT(glm::length(warp_point(mesh, outside, -0.1) - dvec3(1.2, 0.1, -0.1)), 1e-13);
}

// The chord lies below the arc by up to r (1 - cos(pi/n)); normals interpolated over the chord are exact to second
// order.
TEST(Warp, TubeApproachesTheCylinder) {
  const double radius = 0.1, height = 0.3;
  double previous = 1;
  for (const int n : {16, 32, 64}) {
    const BaseMesh mesh = make_tube(radius, height, n, 8);
    const auto charts = find_charts(mesh);
    const ChartLocator locator(mesh, charts[0]);
    double worst = 0;
    for (double u = 0.001; u < 2 * std::numbers::pi * radius; u += 0.0123)
      for (double v = 0.001; v < height; v += 0.0371) {
        ChartPoint at;
        ASSERT_TRUE(locator.locate({u, v}, 0, {1, 1}, at));
        const double r = radius + 0.02;
        const dvec3 exact(r * std::cos(u / radius), r * std::sin(u / radius), v);
        worst = std::max(worst, glm::length(warp_point(mesh, at, 0.02) - exact));
      }
    EXPECT_LT(worst, 1.3 * radius * (1 - std::cos(std::numbers::pi / n)));
    EXPECT_LT(worst, 0.3 * previous);  // second order
    previous = worst;
  }
}

TEST(Warp, SphereApproachesTheSphere) {
  // Upper cap by (longitude, latitude), with exact normals.
  const int n = 64;
  BaseMesh mesh = make_swatch(1, 1, n, n);
  for (size_t t = 0; t < mesh.triangle.size(); ++t)
    for (size_t c = 0; c < 3; ++c) {
      const dvec2 uv = mesh.uv[t][c];
      const dvec3 p(std::cos(uv.y) * std::cos(uv.x), std::cos(uv.y) * std::sin(uv.x), std::sin(uv.y));
      mesh.position[mesh.triangle[t][c]] = p;
      mesh.normal[mesh.triangle[t][c]] = p;
    }
  const auto charts = find_charts(mesh);
  const ChartLocator locator(mesh, charts[0]);
  double worst = 0, worst_slope = 0;
  for (double u = 0.01; u < 1; u += 0.031)
    for (double v = 0.01; v < 1; v += 0.029) {
      ChartPoint at;
      ASSERT_TRUE(locator.locate({u, v}, 0, {1, 1}, at));
      const dvec3 p(std::cos(v) * std::cos(u), std::cos(v) * std::sin(u), std::sin(v));
      const dvec3 du(-std::cos(v) * std::sin(u), std::cos(v) * std::cos(u), 0);
      worst = std::max(worst, glm::length(warp_point(mesh, at, 0.1) - 1.1 * p));
      worst_slope = std::max(worst_slope, glm::length(warp_jacobian(mesh, at, 0.1, {1, 1})[0] - 1.1 * du));
    }
  EXPECT_LT(worst, 1e-4);        // sagitta of a cell's diagonal, (sqrt(2)/64)^2 / 8 = 6.1e-5, and its normals
  EXPECT_LT(worst_slope, 0.02);  // first order in the cell size, 1/64
}

TEST(Warp, JacobianEqualsDifferences) {
  const BaseMesh mesh = make_draped_square(0.6, 0.12, 24);
  const auto charts = find_charts(mesh);
  const dvec2 per_metre(1.7, 0.6);
  for (uint32_t t = 0; t < mesh.triangle.size(); t += 7) {
    const auto& uv = mesh.uv[t];
    const double det = uv_area2(uv), step = 1e-7, height = 0.004;
    const dvec2 e1 = uv[1] - uv[0], e2 = uv[2] - uv[0];
    const auto moved = [&](dvec2 d) {
      ChartPoint at{t, 0.3, 0.25, 0};
      at.b1 += (d.x * e2.y - d.y * e2.x) / det;
      at.b2 += (e1.x * d.y - e1.y * d.x) / det;
      return warp_point(mesh, at, height);
    };
    const dmat3 j = warp_jacobian(mesh, {t, 0.3, 0.25, 0}, height, per_metre);
    const dvec2 dx(step * per_metre.x, 0), dy(0, step * per_metre.y);
    EXPECT_LT(glm::length((moved(dx) - moved(-dx)) / (2 * step) - j[0]), 1e-6);
    EXPECT_LT(glm::length((moved(dy) - moved(-dy)) / (2 * step) - j[1]), 1e-6);
    EXPECT_NEAR(glm::length(j[2]), 1, 1e-12);
  }
}

}  // namespace
}  // namespace wale
