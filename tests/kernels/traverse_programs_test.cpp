// Every variant of the geometry kernels compiles: widths, portable masks, local stages, double.
#include <gtest/gtest.h>

#include "host/program.h"

namespace wale {
namespace {

constexpr const char* kTrace = R"(
#include "geometry/ply_surface.clh"
__kernel void trace(__global const uint* nodes, __global const uint* leaves, __global const float* frames,
                    __global const float* rays, __global uint* counters, __global w_real* out, WScene_extra uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  WScene s;
  s.nodes = nodes; s.leaves = leaves; s.ply_root = 0; s.tri_root = W_NONE; s.spheres_count = 0; s.counters = counters;
  WRay r;
  r.o = w_load3(0, rays); r.l = w_load3(1, rays); r.d = w_load3(2, rays); r.tmax = rays[9]; r.key = i;
  r.skip = r.skip_triangle = W_NONE;
  const WHit hit = w_closest(&s, &r);
  const WPlySurface p = w_ply_surface(&s, frames, &r, &hit, W_NORMALS_ROTATION_MINIMISING);
  vstore3(p.x, i, out);
  out[3 * count + i] = w_occluded(&s, &r) ? R(1.0) : hit.t;
}
)";

class Variants : public testing::TestWithParam<const char*> {};

TEST_P(Variants, Compile) {
  const Device device = Device::open();
  if (std::string(GetParam()).find("W_DOUBLE") != std::string::npos && !device.traits().fp64)
    GTEST_SKIP() << "the device has no cl_khr_fp64";
  EXPECT_NO_THROW(build_program_text(
      device, kTrace, std::string("-DWScene_extra= -DW_HAS_PLIES -DW_HAS_TRIANGLES -DW_HAS_SPHERES ") + GetParam()));
}

INSTANTIATE_TEST_SUITE_P(Widths, Variants,
                         testing::Values("-DW_LANES=1", "-DW_LANES=8", "-DW_LANES=16", "-DW_LANES=8 -DW_PORTABLE",
                                         "-DW_LANES=16 -DW_PORTABLE", "-DW_LANES=1 -DW_LOCAL_STAGE=1",
                                         "-DW_LANES=16 -DW_LOCAL_STAGE=2", "-DW_LANES=1 -DW_SIMT",
                                         "-DW_LANES=1 -DW_SIMT -DW_PORTABLE"));
INSTANTIATE_TEST_SUITE_P(Double, Variants,
                         testing::Values("-DW_LANES=1 -DW_DOUBLE", "-DW_LANES=1 -DW_DOUBLE -DW_SIMT",
                                         "-DW_LANES=1 -DW_DOUBLE -DW_LOCAL_STAGE=1",
                                         "-DW_LANES=1 -DW_DOUBLE -DW_LOCAL_STAGE=2 -DW_PORTABLE -DW_HAS_FIBRES"));

TEST(Programs, WarpAndPackCompile) {
  const Device device = Device::open();
  EXPECT_NO_THROW(build_program(device, "warp.cl"));
  EXPECT_NO_THROW(build_program(device, "pack.cl"));
  EXPECT_NO_THROW(build_program(device, "quantise.cl"));
}

}  // namespace
}  // namespace wale
