// integrator.normals: how far the shading normal of each level lies from that of the curved ply.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/kernels/joint_rays.h"
#include "tests/kernels/synthetic.h"
#include "tests/tolerances.h"

namespace wale::test {
namespace {

constexpr const char* kLevels[] = {"W_NORMALS_FLAT", "W_NORMALS_LINEAR", "W_NORMALS_ROTATION_MINIMISING"};

std::vector<Surface> surfaces(Tracer& tracer, const std::vector<Ray>& rays, const std::vector<Hit>& hits, int level) {
  return tracer.surfaces(rays, hits, std::string("-DW_LANES=16 -DW_TEST_NORMALS=") + kLevels[level]);
}

dvec3 vector_of(const float* v) { return {v[0], v[1], v[2]}; }

/// Largest angles, in radians, between a level's frame and that of a helix of radius R and pitch 2 pi P.
struct Angles {
  double normal = 0, axis = 0;
  double jump = 0;  ///< of the normal between the two sides of a joint
};

Angles angles_of(uint32_t steps, int level) {
  constexpr double R = 4, P = 0.6;
  const Strands s = helix(steps, 4, R, 2 * M_PI * P, 1.0f);
  Tracer tracer(test_device(), s);
  const auto point = [&](double a) { return dvec3(R * std::cos(a), R * std::sin(a), P * a); };
  const auto tangent = [&](double a) { return glm::normalize(dvec3(-R * std::sin(a), R * std::cos(a), P)); };
  const double step = 2 * M_PI / steps;
  Stream random{7};
  std::vector<Ray> rays;
  std::vector<double> place;
  for (int i = 0; i < 6000; ++i) {
    // Pairs on both sides of a joint, and places between.
    const double joint = step * double(3 + random.next() % (4 * steps - 6)), b = 2 * M_PI * random.uniform();
    const double between = joint + step * random.uniform();
    for (const double a : {joint - 1e-4 * step, joint + 1e-4 * step, between}) {
      const dvec3 t = tangent(a), x = glm::normalize(glm::cross(t, {0, 0, 1})), y = glm::cross(t, x);
      const dvec3 n = std::cos(b) * x + std::sin(b) * y;
      rays.push_back(make_ray(point(a) + 1.5 * n, -n, 0));
      place.push_back(a);
    }
  }
  const std::vector<Hit> hits = tracer.trace(rays, "-DW_LANES=16");
  const std::vector<Surface> at = surfaces(tracer, rays, hits, level);
  Angles worst;
  const auto angle = [](dvec3 a, dvec3 b) { return std::asin(std::min(1.0, glm::length(glm::cross(a, b)))); };
  for (size_t i = 0; i < rays.size(); ++i) {
    if (hits[i].kind != W_HIT_PLY || hits[i].t > 1 || int(hits[i].v) != 0) continue;
    const dvec3 n = -vector_of(rays[i].d);
    worst.normal = std::max(worst.normal, angle(vector_of(at[i].smooth_n), n));
    worst.axis = std::max(worst.axis, angle(vector_of(at[i].smooth_t), tangent(place[i])));
    EXPECT_NEAR(glm::dot(vector_of(at[i].smooth_n), vector_of(at[i].smooth_t)), 0, 1e-5);
    EXPECT_NEAR(glm::length(vector_of(at[i].smooth_n)), 1, 1e-5);
    if (i % 3 == 1 && hits[i - 1].kind == W_HIT_PLY && hits[i - 1].t < 1)
      worst.jump = std::max(worst.jump, angle(vector_of(at[i].smooth_n), vector_of(at[i - 1].smooth_n)));
  }
  return worst;
}

// With bend b a joint the flat frame is off by b/2 at joints; the others by b^2.
TEST(NormalLevels, ErrorsOnAHelix) {
  fmt::print("| bend, degrees | normals | normal, degrees | axis, degrees | jump at joints, degrees |\n");
  fmt::print("|---|---|---|---|---|\n");
  for (const uint32_t steps : {14u, 28u, 56u}) {
    const double b = 2 * M_PI / steps * 4 / std::hypot(4, 0.6);
    Angles of[3];
    for (int level = 0; level < 3; ++level) {
      of[level] = angles_of(steps, level);
      fmt::print("| {:.1f} | {} | {:.3f} | {:.3f} | {:.3f} |\n", b * 180 / M_PI, kLevels[level] + 10,
                 of[level].normal * 180 / M_PI, of[level].axis * 180 / M_PI, of[level].jump * 180 / M_PI);
    }
    EXPECT_NEAR(of[0].axis, b / 2, 0.05 * b);
    EXPECT_NEAR(of[0].jump, b, 0.05 * b);
    for (const int level : {1, 2}) {
      EXPECT_LT(of[level].axis, b * b);
      EXPECT_LT(of[level].normal, 0.5 * of[0].normal);
      EXPECT_LT(of[level].jump, b * b);
    }
    // The normal set square to the axis leaves a step of second order at a joint; the carried one none.
    EXPECT_LT(of[2].jump, tolerance::kJointSurface + 1e-3 * b);
  }
}

// A straight ply has one frame: no level changes it.
TEST(NormalLevels, AStraightPlyIsTheSame) {
  Strands s;
  s.add(1, 12, 0.5f, [](uint32_t, uint32_t i) { return dvec3(0.3 * i, 0.5 * i, 0.2 * i); });
  Tracer tracer(test_device(), s);
  const std::vector<Ray> rays = primary_rays(tracer.tree().bounds, 4000, 3);
  const std::vector<Hit> hits = tracer.trace(rays, "-DW_LANES=16");
  const std::vector<Surface> levels[] = {surfaces(tracer, rays, hits, 0), surfaces(tracer, rays, hits, 1),
                                         surfaces(tracer, rays, hits, 2)};
  size_t compared = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    if (hits[i].kind != W_HIT_PLY) continue;
    ++compared;
    for (int level = 0; level < 2; ++level)
      for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(levels[level][i].smooth_n[k], levels[2][i].smooth_n[k], 2e-6);
        EXPECT_NEAR(levels[level][i].smooth_t[k], levels[2][i].smooth_t[k], 2e-6);
        EXPECT_EQ(levels[level][i].n[k], levels[2][i].n[k]);  // sides and starts stay geometric
        EXPECT_EQ(levels[level][i].x[k], levels[2][i].x[k]);
      }
  }
  EXPECT_GT(compared, 500u);
}

}  // namespace
}  // namespace wale::test
