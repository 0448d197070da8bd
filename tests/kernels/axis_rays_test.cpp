// Rays that run along a ply inside its radius have no entry through its side; they are counted, and no others are.
#include <gtest/gtest.h>

#include "tests/kernels/synthetic.h"

namespace wale::test {
namespace {

class AxisRays : public testing::TestWithParam<const char*> {
 protected:
  // Twenty segments along z, one unit each, radius 0.5.
  AxisRays() {
    strands_.add(1, 21, 0.5f, [](uint32_t, uint32_t i) { return dvec3(3, -2, i); });
  }
  /// Events of both traversals, nearest and any, of one ray.
  uint32_t counted(dvec3 origin, dvec3 direction) {
    Tracer tracer(test_device(), strands_);
    const std::vector<Ray> rays = {make_ray(origin, direction, 0)};
    hit_ = (std::string(GetParam()) == "double" ? tracer.trace_in_double(rays)[0].kind
                                                : tracer.trace(rays, GetParam())[0].kind) == W_HIT_PLY;
    return tracer.events()[W_EVENT_PARALLEL];
  }
  Strands strands_;
  bool hit_ = false;
};

TEST_P(AxisRays, AreCountedInsideTheRadiusAlone) {
  if (std::string(GetParam()) == "double" && !test_device().traits().fp64) GTEST_SKIP() << "no cl_khr_fp64";
  // From the middle of segment 4 on: the middles of segments 5 to 19 lie ahead, those of 0 to 4 not.
  EXPECT_EQ(counted({3.2, -2.1, 4.6}, {0, 0, 1}), 2u * 15);
  EXPECT_FALSE(hit_) << "the cap at the end is left from inside";
  EXPECT_EQ(counted({3.2, -2.1, 4.6}, {1e-4, 0, 1}), 2u * 15);
  EXPECT_EQ(counted({3.2, -2.1, 4.6}, {5e-3, 0, 1}), 0u) << "not along the axis";
  EXPECT_EQ(counted({3.52, -2, 4.6}, {0, 0, 1}), 0u) << "outside the radius";
  EXPECT_EQ(counted({3.2, -2.1, 25}, {0, 0, 1}), 0u) << "the ply lies behind";
  EXPECT_FALSE(hit_);
  counted({3.2, -2.1, 25}, {0, 0, -1});
  EXPECT_TRUE(hit_) << "the cap of the open end is met first";
}

INSTANTIATE_TEST_SUITE_P(Builds, AxisRays,
                         testing::Values("-DW_LANES=1", "-DW_LANES=8", "-DW_LANES=16", "-DW_LANES=16 -DW_PORTABLE",
                                         "-DW_LANES=1 -DW_SIMT", "double"));

}  // namespace
}  // namespace wale::test
