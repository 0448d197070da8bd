// Rays in packets find what each finds alone, to the last bit: whatever the company.
#include <gtest/gtest.h>

#include <cstring>

#include "tests/kernels/synthetic.h"

namespace wale::test {
namespace {

const std::string kWide = "-DW_LANES=16";

/// Rays from one point over a field of view of `spread`, in rows of 16.
std::vector<Ray> camera_rays(const Box& bounds, uint32_t side, double spread) {
  const dvec3 lo(bounds.lo[0], bounds.lo[1], bounds.lo[2]), hi(bounds.hi[0], bounds.hi[1], bounds.hi[2]);
  const dvec3 middle = 0.5 * (lo + hi), eye = middle + dvec3(0.3, 0.2, 1.1) * glm::length(hi - lo);
  std::vector<Ray> rays;
  for (uint32_t i = 0; i < side * side; ++i) {
    const double x = double(i % side) / side - 0.5, y = double(i / side) / side - 0.5;
    rays.push_back(make_ray(eye, middle - eye + spread * glm::length(hi - lo) * dvec3(x, y, 0), i));
  }
  return rays;
}

void expect_the_same(Tracer& tracer, const std::vector<Ray>& rays, const char* what) {
  const std::vector<Hit> alone = tracer.trace(rays, kWide), together = tracer.trace_packets(rays);
  size_t hits = 0, different = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    hits += alone[i].kind != W_HIT_NONE;
    different += std::memcmp(&alone[i], &together[i], offsetof(Hit, occluded)) != 0;
  }
  EXPECT_EQ(different, 0u) << what << ": of " << rays.size();
  EXPECT_GT(hits, rays.size() / 20) << what << ": too few hits to tell";
}

void expect_the_same_on(const Strands& strands, const char* name) {
  SCOPED_TRACE(name);
  if (test_device().traits().fp64 && test_device().traits().lanes < 16) GTEST_SKIP() << "packets need 16 lanes";
  Tracer tracer(test_device(), strands);
  const Box& bounds = tracer.tree().bounds;
  expect_the_same(tracer, camera_rays(bounds, 96, 0.8), "wide");
  expect_the_same(tracer, camera_rays(bounds, 96, 0.02), "narrow");
  // Off the plies towards one light, still neighbours: alone they ask w_may_meet first, in packets never.
  const std::vector<Ray> narrow = camera_rays(bounds, 96, 0.02);
  const std::vector<Hit> starts = tracer.trace(narrow, kWide);
  const dvec3 light(0.4 * bounds.lo[0] + 0.6 * bounds.hi[0], 0.5 * (bounds.lo[1] + bounds.hi[1]), bounds.lo[2]);
  std::vector<Ray> lit = bounce_rays(narrow, starts, tracer.surfaces(narrow, starts), 11);
  for (size_t i = 0; i < lit.size(); ++i) {
    const dvec3 start(double(lit[i].o[0]) + lit[i].l[0], double(lit[i].o[1]) + lit[i].l[1],
                      double(lit[i].o[2]) + lit[i].l[2]);
    const dvec3 d = glm::normalize(light - start);
    for (int k = 0; k < 3; ++k) lit[i].d[k] = float(d[k]);
  }
  expect_the_same(tracer, lit, "neighbours off the plies");
  std::vector<Ray> holed = camera_rays(bounds, 96, 0.1);
  for (size_t i = 0; i < holed.size(); i += 5) holed[i].d[i % 3] = NAN;
  expect_the_same(tracer, holed, "some not numbers");
  std::vector<Ray> loose = primary_rays(bounds, 5003, 3);  // not a multiple of the packet, all octants
  expect_the_same(tracer, loose, "all ways");
  const std::vector<Hit> hits = tracer.trace(loose, kWide);
  expect_the_same(tracer, bounce_rays(loose, hits, tracer.surfaces(loose, hits), 5), "off the plies");
  for (size_t i = 0; i < loose.size(); i += 7) loose[i].d[1] = NAN;
  for (size_t i = 3; i < loose.size(); i += 5) loose[i].tmax = 1e-3f * float(i);
  expect_the_same(tracer, loose, "some cut short, some not numbers");
}

TEST(Packets, FindWhatEachRayFindsAlone) {
  expect_the_same_on(stockinette(6, 8, 56), "stockinette");
  expect_the_same_on(helix(12, 20, 0.02, 0.01, 0.004f), "helix");
  expect_the_same_on(random_strands(60, 24, 0.02, 0.1, 0.01f, 7), "tight bends");
}

TEST(Packets, PassThroughThePliesThatEachRayPassesAlone) {
  Strands strands = stockinette(6, 8, 56);
  for (PlyPatch& patch : strands.patches) patch.tau = 0.7f;
  expect_the_same_on(strands, "half transparent");
}

}  // namespace
}  // namespace wale::test
