// The early test of a ray alone (w_may_meet) never turns away what the exact one meets, and is worth asking.
#include <gtest/gtest.h>

#include "tests/kernels/kernel_runner.h"
#include "tests/kernels/ply_kernels.h"
#include "tests/kernels/statistics.h"

namespace wale {
namespace {
using namespace test;

// Case: p0 .. p3, o, l, d, radius, behind, 23 floats. Out: 1 where the exact test meets it, or counts a ray along the
// axis, 1 where the early one may. In every second case entries count from the last number below the entry on; in every
// third both ends are cut square.
const char* kKernels = R"(
#include "geometry/ply_segment.clh"
static inline w_v3 at(__global const float* p) { return w_v3_all(w_load3(0, p)); }
__kernel void both(__global const float* in, __global w_real* out, uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  __global const float* p = in + 23 * (size_t)i;
  const WPlyEdge edge = w_ply_edge(at(p + 3), at(p + 6), at(p + 12), at(p + 15));
  const w_v3 d = at(p + 18);
  const uint cuts = i % 3u == 0u ? 0x10001u : 0u;
  WPlyLanes found;
  uint met =
      w_ply_lanes(at(p), at(p + 3), at(p + 6), at(p + 9), &edge, p[21], d, p[22], W_MISS, 1u, cuts, 0u, 0u, &found);
  float behind = p[22];
  if (met && (i & 1u)) {
    behind = as_float(as_int(found.t) + (found.t > 0.0f ? -1 : 1));
    met =
        w_ply_lanes(at(p), at(p + 3), at(p + 6), at(p + 9), &edge, p[21], d, behind, W_MISS, 1u, cuts, 0u, 0u, &found);
  }
  out[2 * i] = met | found.along;
  out[2 * i + 1] = w_mask_bits(w_may_meet(&edge, p[21], d, behind));
}
)";

struct Share {
  double met = 0, may = 0, lost = 0;
};

// Rays towards points on or near a segment's surface (`miss` radii off the axis), as far along as a mitre of 120
// degrees reaches, started up to `far` radii before it, with directions that are unit to 9e-7.
Share shares(const KernelRunner& runner, double length, double far, double miss, double slant, uint32_t seed) {
  constexpr size_t kCount = 60000;
  Random random(seed);
  std::vector<float> in;
  in.reserve(23 * kCount);
  for (size_t i = 0; i < kCount; ++i) {
    const double r = std::pow(10, random.uniform(-6, 0)), l = r * length * random.uniform(0.2, 1);
    const dvec3 axis = random.direction(), middle = 10 * r * random.direction();
    const auto bent = [&] {
      const double bend = random.uniform(0, 120) * M_PI / 180;
      return std::cos(bend) * axis + std::sin(bend) * glm::normalize(glm::cross(axis, random.direction()));
    };
    const dvec3 p1 = middle - 0.5 * l * axis, p2 = middle + 0.5 * l * axis, p0 = p1 - l * bent(), p3 = p2 + l * bent();
    const dvec3 side = glm::normalize(glm::cross(axis, random.direction()));
    const dvec3 target =
        middle + random.uniform(-1, 1) * (0.5 * l + 1.7321 * r) * axis + r * random.uniform(0, miss) * side;
    // From along the axis (slant 0) to any direction (1).
    const dvec3 d = glm::normalize(axis * (random.uniform() < 0.5 ? 1.0 : -1.0) + slant * 3 * random.direction()) *
                    (1 + random.uniform(-4.5e-7, 4.5e-7));
    const double way = r * far * random.uniform(-0.3, 1);
    const dvec3 start = target - way * d, offset = 0.5 * r * random.direction();
    for (const dvec3& v : {p0, p1, p2, p3, start - offset, offset, d}) append(&in, v);
    in.push_back(float(r));
    // From where the ray starts, before or at o + l, or from a camera far away.
    const double kind = random.uniform();
    in.push_back(float(kind < 0.4 ? -0.2 * way : kind < 0.8 ? 0.0 : -1e5 * r));
  }
  const auto out = runner.run("both", kCount, 2, runner.upload(in));
  Share share;
  for (size_t i = 0; i < kCount; ++i) {
    share.met += out[2 * i] / double(kCount);
    share.may += out[2 * i + 1] / double(kCount);
    share.lost += out[2 * i] > out[2 * i + 1];
  }
  return share;
}

TEST(MayMeet, TurnsNothingAwayThatIsMet) {
  const KernelRunner runner(kKernels, false);
  uint32_t seed = 0;
  double met = 0;
  for (const double length : {0.1, 2.0, 10.0, 60.0})
    for (const double far : {1.0, 30.0, 300.0})
      for (const double miss : {1.0, 1.0001, 3.0})
        for (const double slant : {3e-4, 0.03, 1.0}) {
          const Share share = shares(runner, length, far, miss, slant, ++seed);
          EXPECT_EQ(share.lost, 0) << length << " " << far << " " << miss << " " << slant;
          met += share.met / 108;
        }
  EXPECT_GT(met, 0.05);
}

// Rays past segments of the usual length: few are asked about twice.
TEST(MayMeet, TurnsAwayMostOfTheRest) {
  const KernelRunner runner(kKernels, false);
  const Share share = shares(runner, 4, 10, 12, 1, 7);
  EXPECT_GT(share.met, 0.02);
  EXPECT_LT(share.may - share.met, 0.1);
}

}  // namespace
}  // namespace wale
