// How exact hits are: the float and the double build of the kernels against long double with the same float rays, from
// 10 to 1e6 radii away.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/kernels/parallel.h"
#include "tests/kernels/synthetic.h"
#include "tests/tolerances.h"

namespace wale::test {
namespace {

/// Worst errors over the hits of one list of rays, in ply radii.
struct Errors {
  size_t rays = 0, compared = 0;
  size_t wrong = 0;        ///< other segment, hit against miss: where the ray does not graze
  double off_surface = 0;  ///< of every hit: distance of w_ply_surface's point from the segment's own surface
  double point = 0;        ///< distance from the oracle's point, |h| < 0.99, not along the axis
  double t = 0;            ///< of the hit's distance, beyond half a unit in its last place
};

template <typename Real>
Errors errors_of(const BruteForce& oracle, const Tracer& tracer, const std::vector<Ray>& rays,
                 const std::vector<HitOf<Real>>& hits, const std::vector<SurfaceOf<Real>>& surfaces) {
  std::vector<OracleHit> expected(rays.size());
  parallel_for(rays.size(), [&](size_t i) { expected[i] = oracle.closest(rays[i]); });
  Errors worst;
  worst.rays = rays.size();
  for (size_t i = 0; i < rays.size(); ++i) {
    const OracleHit& e = expected[i];
    const bool hit = hits[i].kind == W_HIT_PLY;
    const bool clear =
        (!hit || std::abs(double(hits[i].u)) < 0.99) && (!e.hit || (std::abs(e.h) < 0.99 && e.edge > 1e-3));
    const bool same = hit && e.hit && tracer.segment(hits[i].code) == e.segment && int(hits[i].v) == e.piece;
    if (clear && hit != e.hit) ++worst.wrong;
    if (!hit) continue;
    const OracleSegment& s = oracle.segment(size_t(oracle.index_of(tracer.segment(hits[i].code))));
    const double r = s.radius;
    const dvec3 x(surfaces[i].x[0], surfaces[i].x[1], surfaces[i].x[2]), axis = s.end - s.start;
    const int piece = int(hits[i].v);
    const dvec3 radial = piece == 0 ? x - glm::dot(x, axis) / glm::dot(axis, axis) * axis : piece == 1 ? x : x - axis;
    worst.off_surface = std::max(worst.off_surface, std::abs(glm::length(radial) - r) / r);
    if (!same || !clear) {
      worst.wrong += clear && e.hit && std::abs(double(hits[i].t - e.exact_t)) > 1e-3 * r + std::ldexp(e.t, -23);
      continue;
    }
    ++worst.compared;
    worst.point = std::max(worst.point, glm::length(x - e.at) / r);
    const double ulp = std::ldexp(e.t, std::is_same_v<Real, float> ? -24 : -53);
    worst.t = std::max(worst.t, (double(std::abs(hits[i].t - e.exact_t)) - ulp) / r);
  }
  return worst;
}

/// Rays from `distance` radii away at points inside the plies, all inputs rounded to float.
std::vector<Ray> rays_from(const Strands& s, double radius, double distance, size_t count) {
  std::mt19937 random(17);
  std::normal_distribution<double> normal;
  std::vector<Ray> rays;
  while (rays.size() < count) {
    const float* v = s.positions.data() + random() % (s.positions.size() / 3) * 3;
    const dvec3 off(normal(random), normal(random), normal(random));
    Ray ray = make_ray({0, 0, 0}, {normal(random), normal(random), normal(random)}, uint32_t(rays.size()));
    const dvec3 d(ray.d[0], ray.d[1], ray.d[2]);
    const dvec3 o = dvec3(v[0], v[1], v[2]) + radius * 0.5 * off - radius * distance * d;
    for (int k = 0; k < 3; ++k) ray.o[k] = float(o[k]);
    rays.push_back(ray);
  }
  return rays;
}

struct Shape {
  const char* name;
  Strands strands;
  double radius;
};

std::vector<Shape> shapes() {
  return {{"helix", helix(24, 8, 3.3, 2.5, 1.0f), 1.0},
          {"random bends", random_strands(40, 12, 1.0, 12, 0.4f, 7), 0.4f},
          {"stockinette", stockinette(3, 4, 40), 0.0029f}};
}

TEST(HitPrecision, HitsFromAnyDistance) {
  const bool fp64 = test_device().traits().fp64;
  fmt::print(
      "| shape | distance, radii | build | rays | compared | wrong | off the surface | from the oracle's point | t "
      "|\n");
  fmt::print("|---|---|---|---|---|---|---|---|---|\n");
  for (const Shape& shape : shapes()) {
    const BruteForce oracle(shape.strands.patches, shape.strands.positions);
    Tracer tracer(test_device(), shape.strands);
    for (const double distance : {10.0, 1e3, 1e4, 1e5, 1e6}) {
      const std::vector<Ray> rays = rays_from(shape.strands, shape.radius, distance, 10000);
      const auto report = [&](const char* build, const Errors& e) {
        fmt::print("| {} | {:g} | {} | {} | {} | {} | {:.2g} | {:.2g} | {:.2g} |\n", shape.name, distance, build,
                   e.rays, e.compared, e.wrong, e.off_surface, e.point, e.t);
        EXPECT_GT(e.compared, e.rays / 2);
        EXPECT_EQ(e.wrong, 0u);
      };
      const std::vector<Hit> hits = tracer.trace(rays, "-DW_LANES=16");
      const Errors once = errors_of(oracle, tracer, rays, hits, tracer.surfaces(rays, hits));
      report("float", once);
      EXPECT_LT(once.off_surface, tolerance::kOffSurfaceFloat);
      EXPECT_LT(once.point, tolerance::kPointFloat);
      EXPECT_LT(once.t, tolerance::kPointFloat);
      if (!fp64) continue;
      const std::vector<HitOf<double>> precise = tracer.trace_in_double(rays);
      const Errors twice = errors_of(oracle, tracer, rays, precise, tracer.surfaces_in_double(rays, precise));
      report("double", twice);
      EXPECT_LT(twice.off_surface, tolerance::kPointDouble);
      EXPECT_LT(twice.point, tolerance::kPointDouble);
      EXPECT_LT(twice.t, tolerance::kPointDouble);
    }
  }
  if (!fp64) GTEST_SKIP() << "the double build needs cl_khr_fp64";
}

// One ply in another, 2e-4 radii deeper: the outer one is met first from any distance, also where t itself, as a float,
// cannot tell them apart. The deeper ply comes first in the list, so that ties would go to it.
TEST(HitPrecision, NeighbouringPliesKeepTheirOrder) {
  constexpr double kApart = 2e-4;
  Strands s;
  for (const double depth : {kApart, 0.0})
    s.add(1, 8, 1.0f, [&](uint32_t, uint32_t i) { return dvec3(1.3 * i, 0, 7 - depth); });
  const BruteForce oracle(s.patches, s.positions);
  Tracer tracer(test_device(), s);
  std::mt19937 random(23);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const double distance : {10.0, 1e3, 1e5, 1e6}) {
    std::vector<Ray> rays;
    for (int n = 0; n < 20000; ++n) {
      Ray ray = make_ray({0, 0, 0}, {0.5 * uniform(random), 0.5 * uniform(random), -1}, uint32_t(n));
      const dvec3 d(ray.d[0], ray.d[1], ray.d[2]);
      const dvec3 o = dvec3(4.5 + 3 * uniform(random), 0.8 * uniform(random), 7) - distance * d;
      for (int k = 0; k < 3; ++k) ray.o[k] = float(o[k]);
      rays.push_back(ray);
    }
    const std::vector<Hit> hits = tracer.trace(rays, "-DW_LANES=16");
    size_t wrong = 0, compared = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
      const OracleHit e = oracle.closest(rays[i]);
      if (!e.hit || std::abs(e.h) > 0.9 || e.segment < 8) continue;
      ++compared;
      wrong += hits[i].kind != W_HIT_PLY || tracer.segment(hits[i].code) < 8;
    }
    EXPECT_GT(compared, rays.size() / 2) << distance;
    EXPECT_EQ(wrong, 0u) << distance;
  }
}

}  // namespace
}  // namespace wale::test
