// Named hard cases of the ray and ply intersection (docs: numerics).
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/kernels/synthetic.h"

namespace wale::test {
namespace {

using std::numbers::pi;

dvec3 vertex(const Strands& s, size_t i) {
  const float* v = s.positions.data() + i * 3;
  return {v[0], v[1], v[2]};
}

// Rays aimed exactly into the mitre planes of a bent strand (kappa r = 0.3), inside its outline, must all hit.
void mitres_are_watertight(dvec3 offset, size_t allowed) {
  Strands s;
  const auto point = [&](uint32_t, uint32_t i) {
    const double a = 2 * pi * i / 20;
    return offset + dvec3(3.2 * std::cos(a), 3.2 * std::sin(a), 1.0 * a / (2 * pi));
  };
  s.add(1, 200, 1.0f, point);
  Tracer tracer(test_device(), s);
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<Ray> rays;
  for (int n = 0; n < 100000; ++n) {
    const size_t v = 2 + random() % 196;
    const dvec3 p = vertex(s, v);
    const dvec3 m = glm::normalize(glm::normalize(p - vertex(s, v - 1)) + glm::normalize(vertex(s, v + 1) - p));
    const dvec3 in = glm::normalize(glm::cross(m, {normal(random), normal(random), normal(random)}));
    const dvec3 side = glm::cross(m, in);
    rays.push_back(make_ray(p - 8.0 * in + 0.98 * uniform(random) * side, in, uint32_t(n)));
  }
  size_t missed = 0;
  for (const Hit& hit : tracer.trace(rays, "-DW_LANES=16")) missed += hit.kind != W_HIT_PLY;
  EXPECT_LE(missed, allowed);
}
TEST(Joints, MitrePlanesAreWatertight) { mitres_are_watertight({0, 0, 0}, 0); }
TEST(Joints, MitrePlanesAreWatertightFarFromTheSceneOrigin) { mitres_are_watertight({1000, -700, 400}, 10); }

// A straight cylinder seen from 10 to 1e6 radii: the hit's distance from the axis, found again about the foot point.
TEST(Joints, FarOriginsKeepThePointOnTheSurface) {
  Strands s;
  s.add(1, 6, 1.0f, [](uint32_t, uint32_t i) { return dvec3(0, 0, 2.0 * i); });
  Tracer tracer(test_device(), s);
  std::mt19937 random(6);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (double distance : {10.0, 1e3, 1e5, 1e6}) {
    std::vector<Ray> rays;
    for (int n = 0; n < 5000; ++n) {
      const double a = pi * uniform(random);
      const dvec3 in(std::cos(a), std::sin(a), 0.3 * uniform(random)), side(-std::sin(a), std::cos(a), 0);
      Ray ray = make_ray({0, 0, 0}, in, uint32_t(n));
      const dvec3 d(ray.d[0], ray.d[1], ray.d[2]);
      const dvec3 o = dvec3(0, 0, 5 + 3 * uniform(random)) + 0.9 * uniform(random) * side - distance * d;
      for (int k = 0; k < 3; ++k) ray.o[k] = float(o[k]);
      rays.push_back(ray);
    }
    const std::vector<Hit> hits = tracer.trace(rays, "-DW_LANES=16");
    const std::vector<Surface> surfaces = tracer.surfaces(rays, hits);
    size_t missed = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
      if (hits[i].kind != W_HIT_PLY) {
        ++missed;
        continue;
      }
      ASSERT_LT(std::abs(std::hypot(surfaces[i].x[0], surfaces[i].x[1]) - 1.0), 5e-7) << distance;
      // Along the ray: what the rounding of origin and direction leaves.
      const dvec3 at = dvec3(rays[i].o[0], rays[i].o[1], rays[i].o[2]) +
                       double(hits[i].t) * dvec3(rays[i].d[0], rays[i].d[1], rays[i].d[2]);
      const dvec3 on(surfaces[i].anchor[0] + surfaces[i].x[0], surfaces[i].anchor[1] + surfaces[i].x[1],
                     surfaces[i].anchor[2] + surfaces[i].x[2]);
      ASSERT_LT(glm::length(at - on), 2e-6 + 2e-7 * distance) << distance;
    }
    EXPECT_EQ(missed, 0u) << distance;
  }
}

// A ray that leaves a convex ply outward never meets the same segment or its straight neighbours again.
TEST(Joints, OutwardRaysDoNotMeetAConvexPlyAgain) {
  for (double scale : {1e-4, 1.0, 1e3}) {
    Strands s;
    s.add(1, 8, float(scale),
          [&](uint32_t, uint32_t i) { return scale * (dvec3(40, -70, 30) + double(i) * dvec3(0.9, 0.7, -0.4)); });
    Tracer tracer(test_device(), s);
    const std::vector<Ray> rays = primary_rays(tracer.tree().bounds, 10000, 9);
    const std::vector<Hit> hits = tracer.trace(rays, "-DW_LANES=16");
    const std::vector<Ray> bounce = bounce_rays(rays, hits, tracer.surfaces(rays, hits), 4);
    ASSERT_GT(bounce.size(), 1000u);
    size_t again = 0;
    for (const Hit& hit : tracer.trace(bounce, "-DW_LANES=16")) again += hit.kind != W_HIT_NONE;
    EXPECT_EQ(again, 0u) << scale;
  }
}

// Turning back on itself, tight bends, repeated points: no NaN, and nothing that looks through the joint.
TEST(Joints, FoldsAndTightBendsAndRepeatedPointsAreClosed) {
  const std::vector<std::vector<dvec3>> lines = {
      {{0, 0, 0}, {4, 0, 0}, {0, 0.0, 0}, {4, 0, 0.1}},                       // 180 degree folds
      {{0, 0, 0}, {0.4, 0, 0}, {0.5, 0.35, 0}, {0.2, 0.5, 0}, {-1, 0.5, 0}},  // segments shorter than a mitre
      {{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 0, 0}, {2, 1, 0}, {3, 1, 0}},     // points repeated
      {{5, 5, 5}, {5, 5, 5}, {5, 5, 5}},                                      // nothing but one point
  };
  for (size_t n = 0; n < lines.size(); ++n) {
    const auto& line = lines[n];
    Strands s;
    s.add(1, uint32_t(line.size()), 0.5f, [&](uint32_t, uint32_t i) { return line[i]; });
    Tracer tracer(test_device(), s);
    // Rays at points of the axis hit from every side.
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform(0, 1);
    std::vector<Ray> rays;
    for (int k = 0; k < 20000; ++k) {
      const size_t i = random() % (line.size() - 1);
      const double u = uniform(random);
      const dvec3 target = line[i] + u * (line[i + 1] - line[i]);
      const dvec3 d = glm::normalize(dvec3(normal(random), normal(random), normal(random)));
      rays.push_back(make_ray(target - 20.0 * d, d, uint32_t(k)));
    }
    const std::vector<Hit> hits = tracer.trace(rays, "-DW_LANES=16");
    const std::vector<Surface> surfaces = tracer.surfaces(rays, hits);
    size_t missed = 0, not_finite = 0;
    for (size_t i = 0; i < hits.size(); ++i) {
      missed += hits[i].kind != W_HIT_PLY || hits[i].t > 20.01f;
      if (hits[i].kind != W_HIT_PLY) continue;
      const Surface& p = surfaces[i];
      const float all[] = {p.x[0], p.x[1], p.x[2], p.n[0],   p.n[1], p.n[2],        p.t[0],        p.t[1],
                           p.t[2], p.phi,  p.u,    p.length, p.h,    p.smooth_n[0], p.smooth_n[1], p.smooth_n[2]};
      for (float x : all) not_finite += !std::isfinite(x);
      EXPECT_NEAR(p.n[0] * p.t[0] + p.n[1] * p.t[1] + p.n[2] * p.t[2], 0, 2e-4);
      EXPECT_LE(p.n[0] * rays[i].d[0] + p.n[1] * rays[i].d[1] + p.n[2] * rays[i].d[2], 1e-3);
    }
    EXPECT_EQ(missed, 0u) << "line " << n;
    EXPECT_EQ(not_finite, 0u) << "line " << n;
  }
}

// Open ends are round: rays along the axis meet the cap at its pole.
TEST(Joints, EndsAreCapped) {
  Strands s;
  s.add(1, 3, 0.5f, [](uint32_t, uint32_t i) { return dvec3(0, 0, i); });
  Tracer tracer(test_device(), s);
  const std::vector<Hit> hits = tracer.trace(
      {make_ray({0, 0, -5}, {0, 0, 1}, 0), make_ray({0, 0, 9}, {0, 0, -1}, 1), make_ray({0, 0.6, -5}, {0, 0, 1}, 2)},
      "-DW_LANES=16");
  EXPECT_FLOAT_EQ(hits[0].t, 4.5f);
  EXPECT_FLOAT_EQ(hits[1].t, 6.5f);
  EXPECT_EQ(hits[2].kind, uint32_t(W_HIT_NONE));
}

// Zero direction components, origins in box planes, rays along plies.
TEST(Joints, AxisParallelRaysAreNotLost) {
  Strands s;
  for (int row = 0; row < 20; ++row) s.add(1, 20, 0.45f, [&](uint32_t, uint32_t i) { return dvec3(i, row, 0); });
  Tracer tracer(test_device(), s);
  std::vector<Ray> rays;
  for (int x = 0; x < 20; ++x)
    for (int y = 0; y < 20; ++y)
      for (double sign : {0.0, -0.0}) {
        Ray ray = make_ray({double(x), double(y), 7}, {0, 0, -1}, 0);
        ray.d[0] = ray.d[1] = float(sign);
        rays.push_back(ray);
      }
  for (const Hit& hit : tracer.trace(rays, "-DW_LANES=16")) EXPECT_NEAR(hit.t, 6.55f, 1e-5f);
}

// Azimuth and length agree on both sides of every joint.
TEST(Joints, AzimuthAndLengthAreContinuous) {
  const Strands s = helix(18, 3, 3.0, 3.0, 1.0f);
  Tracer tracer(test_device(), s);
  std::mt19937 random(8);
  std::uniform_real_distribution<double> uniform(-pi, pi);
  std::vector<Ray> rays;
  for (int n = 0; n < 4000; ++n) {
    const size_t v = 3 + random() % 45;
    const dvec3 p = vertex(s, v);
    const dvec3 t = glm::normalize(p - vertex(s, v - 1)), m = glm::normalize(t + glm::normalize(vertex(s, v + 1) - p));
    const dvec3 x = glm::normalize(glm::cross(m, {0, 0, 1})), y = glm::cross(m, x);
    const double a = uniform(random);
    const dvec3 radial = std::cos(a) * x + std::sin(a) * y;
    for (double side : {-2e-4, 2e-4}) rays.push_back(make_ray(p + side * m + 1.6 * radial, -radial, uint32_t(n)));
  }
  const std::vector<Hit> hits = tracer.trace(rays, "-DW_LANES=16");
  const std::vector<Surface> at = tracer.surfaces(rays, hits);
  size_t compared = 0;
  for (size_t i = 0; i < rays.size(); i += 2) {
    if (hits[i].kind != W_HIT_PLY || hits[i + 1].kind != W_HIT_PLY) continue;
    if (at[i].segment + 1 != at[i + 1].segment || std::abs(hits[i].t - hits[i + 1].t) > 2e-3f) continue;
    ++compared;
    EXPECT_NEAR(std::remainder(at[i].phi - at[i + 1].phi, 2 * pi), 0, 3e-3);
    EXPECT_NEAR(at[i].length, at[i + 1].length, 3e-3);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(at[i].smooth_n[k], at[i + 1].smooth_n[k], 3e-3);
  }
  EXPECT_GT(compared, 1000u);
}

}  // namespace
}  // namespace wale::test
