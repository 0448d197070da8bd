// The kernels against the double-precision oracle, for every width and the portable path.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>

#include "tests/kernels/synthetic.h"

namespace wale::test {
namespace {

struct Case {
  const char* name;
  Strands strands;
  float radius;
};

std::vector<Case> cases() {
  std::vector<Case> all;
  all.push_back({"helix", helix(24, 8, 3.3, 2.5, 1.0f), 1.0f});
  all.push_back({"random", random_strands(150, 12, 1.0, 18, 0.4f, 7), 0.4f});
  all.push_back({"stockinette", stockinette(5, 6, 40), 0.0029f});
  Strands soft = stockinette(4, 5, 30);
  for (PlyPatch& p : soft.patches) p.tau = 0.6f;
  all.push_back({"passing light", soft, 0.0029f});
  Strands soft_random = random_strands(100, 12, 0.6, 14, 0.4f, 11);
  for (PlyPatch& p : soft_random.patches) p.tau = 0.4f;
  all.push_back({"passing light, tight bends", soft_random, 0.4f});
  return all;
}

// Differences that float may make: rays that graze a silhouette, a joint or the edge of a random decision.
void compare(const Case& c, const Tracer& tracer, const BruteForce& oracle, const std::vector<Ray>& rays,
             const std::vector<Hit>& hits, const std::string& what) {
  size_t differ = 0, far = 0, occlusion = 0, hit = 0;
  double worst = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    const OracleHit expected =
        oracle.closest(rays[i], rays[i].skip == W_NONE ? -1 : long(tracer.segment(rays[i].skip)));
    const bool is_hit = hits[i].kind == W_HIT_PLY;
    occlusion += is_hit != (hits[i].occluded != 0);
    hit += is_hit;
    if (is_hit != expected.hit) {
      ++differ;
      continue;
    }
    if (!is_hit) continue;
    const double dt = std::abs(hits[i].t - expected.t) / c.radius;
    if (dt > 1e-3)
      ++far;
    else
      worst = std::max(worst, dt);
  }
  const size_t allowed = 1 + rays.size() / 50000;
  EXPECT_LE(differ, allowed) << c.name << " " << what << ": hit or miss";
  EXPECT_LE(far, allowed) << c.name << " " << what << ": |dt| > 1e-3 r";
  EXPECT_EQ(occlusion, 0u) << c.name << " " << what;
  EXPECT_GT(hit, rays.size() / 20) << c.name << " " << what;
}

TEST(Oracle, ClosestAndOccludedAgreeAtEveryWidth) {
  const Device& device = test_device();
  for (const Case& c : cases()) {
    const BruteForce oracle(c.strands.patches, c.strands.positions);
    Tracer tracer(device, c.strands);
    ASSERT_EQ(oracle.segments(), c.strands.segments());
    const std::vector<Ray> primary = primary_rays(tracer.tree().bounds, 25000, 3);
    const std::vector<Hit> first = tracer.trace(primary, "-DW_LANES=16");
    compare(c, tracer, oracle, primary, first, "primary");
    const std::vector<Ray> bounce = bounce_rays(primary, first, tracer.surfaces(primary, first), 5);
    const std::vector<Hit> second = tracer.trace(bounce, "-DW_LANES=16");
    compare(c, tracer, oracle, bounce, second, "bounce");
    EXPECT_EQ(tracer.stack_overflows(), 0u);
    for (const char* options :
         {"-DW_LANES=1", "-DW_LANES=8", "-DW_LANES=16 -DW_PORTABLE", "-DW_LANES=8 -DW_PORTABLE",
          "-DW_LANES=1 -DW_PORTABLE", "-DW_LANES=1 -DW_SIMT", "-DW_LANES=1 -DW_SIMT -DW_PORTABLE"}) {
      const auto same = [](const std::vector<Hit>& a, const std::vector<Hit>& b) {
        size_t differ = 0;
        for (size_t i = 0; i < a.size(); ++i)
          differ += a[i].t != b[i].t || a[i].code != b[i].code || a[i].u != b[i].u || a[i].occluded != b[i].occluded;
        return differ;
      };
      EXPECT_EQ(same(tracer.trace(primary, options), first), 0u) << c.name << " " << options;
      EXPECT_EQ(same(tracer.trace(bounce, options), second), 0u) << c.name << " " << options;
    }
  }
}

}  // namespace
}  // namespace wale::test
