// Fabrics on the device: the warp against its double reference, frames, and the three local stages on one cloth.
#include "host/fabric_device.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "geom/base_mesh_generators.h"
#include "geom/warp.h"
#include "host/program.h"
#include "tests/kernels/synthetic.h"

namespace wale::test {
namespace {

Fabric knit(BaseMesh mesh) {
  FabricSpec spec;
  spec.scale.kind = FabricScale::Kind::uv_metres;
  spec.tolerance = 0.05;
  return knit_fabric(std::move(mesh), stockinette_pattern(0.004), spec);
}

void warp_agrees(const Fabric& fabric, dvec3 origin) {
  const FabricInput input{&fabric, 0, -1};
  const FabricWarp warp(test_device(), {&input, 1}, origin);
  const std::vector<float> points = warp.points().read(test_device()), frames = warp.frames().read(test_device());
  ASSERT_EQ(points.size(), fabric.anchors.size() * 3);
  ASSERT_EQ(frames.size(), fabric.anchors.size() * W_FRAME_WORDS);
  const auto at = [&](size_t i) { return dvec3(points[3 * i], points[3 * i + 1], points[3 * i + 2]); };
  for (size_t i = 0; i < fabric.anchors.size(); ++i) {
    const Anchor& a = fabric.anchors[i];
    const dvec3 expected = warp_point(fabric.mesh, {a.triangle, a.b1, a.b2, 0}, a.height) - origin;
    const float* f = &frames[i * W_FRAME_WORDS];
    // The second term: corners and sum are floats that far from the scene origin.
    ASSERT_LT(glm::length(at(i) - expected), 2e-4 * fabric.ply_radius + 2.4e-7 * glm::length(expected)) << i;
    ASSERT_NEAR(f[0] * f[0] + f[1] * f[1] + f[2] * f[2], 1, 1e-5) << i;
    ASSERT_EQ(f[3], a.length);
  }
  // Carried normals: square to the mean edge, and the Jacobian's image of the flat one up to that projection.
  for (const PlyRun& run : fabric.runs)
    for (uint32_t k = 1; k + 1 < run.count; ++k) {
      const size_t i = run.first_vertex + k;
      const dvec3 t = glm::normalize(glm::normalize(at(i) - at(i - 1)) + glm::normalize(at(i + 1) - at(i)));
      const float* f = &frames[i * W_FRAME_WORDS];
      const dvec3 n(f[0], f[1], f[2]);
      const Anchor& a = fabric.anchors[i];
      const dmat3 jacobian =
          warp_jacobian(fabric.mesh, {a.triangle, a.b1, a.b2, 0}, a.height, fabric.uv_per_metre[run.chart]);
      const dvec3 carried = jacobian * dvec3(a.nx, a.ny, a.nz);
      ASSERT_LT(std::abs(glm::dot(n, t)), 2e-3);
      ASSERT_LT(glm::length(n - glm::normalize(carried - glm::dot(carried, t) * t)), 5e-3);
    }
}

TEST(FabricDevice, WarpAgreesOnASwatch) { warp_agrees(knit(make_swatch(0.03, 0.03, 2, 3)), {0, 0, 0}); }
TEST(FabricDevice, WarpAgreesOnADrapedSquare) { warp_agrees(knit(make_draped_square(0.04, 0.01, 12)), {1, -2, 0.5}); }

constexpr const char* kStage = R"(
#include "geometry/traverse.clh"
typedef struct TestRay { float o[3], l[3], d[3]; float tmax; uint key, skip, skip_triangle, pad; } TestRay;
__kernel void trace(__global const uint* nodes, __global const uint* node_cell, __global const uint* leaves,
                    __global uint* counters, __global const float* base_positions, __global const uint* base_indices,
                    __global const float* base_uv, __global const uint* cell_triangle_offsets,
                    __global const uint* cell_triangles, __global const uint* cell_segment_offsets,
                    __global const uint* cell_segments, __global const WGrid* grids, __global const uint* grid_of_cell,
                    __global const TestRay* rays, __global float* out, uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  WScene s;
  s.nodes = nodes;
  s.node_cell = node_cell;
  s.leaves = leaves;
  s.ply_root = 0;
  s.tri_root = W_NONE;
  s.spheres_count = 0;
  s.counters = counters;
#if W_LOCAL_STAGE
  s.base_positions = base_positions;
  s.base_indices = base_indices;
  s.base_uv = base_uv;
  s.cell_triangle_offsets = cell_triangle_offsets;
  s.cell_triangles = cell_triangles;
  s.cell_segment_offsets = cell_segment_offsets;
  s.cell_segments = cell_segments;
  s.grids = grids;
  s.grid_of_cell = grid_of_cell;
#endif
  WRay r;
  r.o = vload3(0, rays[i].o);
  r.l = (float3)(0.0f);
  r.d = vload3(0, rays[i].d);
  r.tmax = rays[i].tmax;
  r.key = rays[i].key;
  r.skip = r.skip_triangle = W_NONE;
  out[i] = w_closest(&s, &r).t;
}
)";

std::vector<float> trace(const FabricDevice& f, const std::vector<Ray>& rays, int stage) {
  const Device& device = test_device();
  const Buffer<Ray> in(device, rays);
  const Buffer<float> out(device, rays.size());
  Buffer<uint32_t> counters(device, W_EVENT_COUNT);
  counters.fill(device, 0);
  cl::Kernel kernel(build_program_text(device, kStage, fmt::format("-DW_HAS_PLIES -DW_LOCAL_STAGE={}", stage)),
                    "trace");
  int arg = 0;
  for (const cl::Buffer& buffer :
       {f.tree.nodes.cl(), f.tree.node_cell.cl(), f.tree.leaves.cl(), counters.cl(), f.base_positions.cl(),
        f.base_indices.cl(), f.base_uv.cl(), f.cell_triangle_offsets.cl(), f.cell_triangles.cl(),
        f.cell_segment_offsets.cl(), f.cell_segments.cl(), f.grids.cl(), f.grid_of_cell.cl(), in.cl(), out.cl()})
    kernel.setArg(arg++, buffer);
  kernel.setArg(arg, uint32_t(rays.size()));
  device.queue().enqueueNDRangeKernel(kernel, cl::NullRange, device.global(rays.size()), device.local());
  return out.read(device);
}

// Seen from straight above, the cell stages find nearly what the exact one finds, the ring more of it, and never
// anything nearer than the nearest.
TEST(FabricDevice, CellStagesFindNearlyWhatTheExactOneFinds) {
  for (bool tube : {false, true}) {
    const Fabric fabric = knit(tube ? make_tube(0.02, 0.03, 24, 2) : make_swatch(0.04, 0.03, 1, 1));
    const FabricInput input{&fabric, 0, -1};
    const FabricDevice device = upload_fabrics(test_device(), {&input, 1}, {0, 0, 0}, LocalStage::cell);
    ASSERT_GT(device.segment_count, 500u);
    ASSERT_GT(device.cell_count, 4u);
    std::mt19937 random(4);
    std::uniform_real_distribution<double> uniform(-1, 1);
    std::vector<Ray> rays;
    for (int i = 0; i < 10000; ++i) {
      if (tube) {
        const double a = 3.14159 * uniform(random);
        const dvec3 out(std::cos(a), std::sin(a), 0);
        rays.push_back(make_ray(0.2 * out + dvec3(0, 0, 0.015 + 0.012 * uniform(random)), -out, uint32_t(i)));
        rays.back().tmax = 0.2f;  // to the axis: what shows through the stitches of the near side is not Algorithm 2's
      } else {
        rays.push_back(make_ray({0.018 * uniform(random), 0.013 * uniform(random), 0.2}, {0, 0, -1}, uint32_t(i)));
      }
    }
    const std::vector<float> exact = trace(device, rays, 0);
    size_t agree[3] = {0, 0, 0}, nearer = 0, hit = 0;
    for (int stage : {1, 2}) {
      const std::vector<float> t = trace(device, rays, stage);
      for (size_t i = 0; i < t.size(); ++i) {
        nearer += t[i] < exact[i] * (1 - 1e-6f);
        agree[stage] += t[i] == exact[i];
      }
    }
    for (float t : exact) hit += t < 1e29f;
    EXPECT_EQ(nearer, 0u);
    EXPECT_GT(hit, rays.size() / 2);
    EXPECT_GT(agree[1], rays.size() * 95 / 100) << "tube " << tube;
    EXPECT_GT(agree[2], rays.size() * 99 / 100) << "tube " << tube;
    EXPECT_GE(agree[2], agree[1]);
  }
}

TEST(FabricDevice, OneTriangleUnderManyCellsIsClippedToEach) {
  const BaseMesh mesh = make_swatch(1, 1, 1, 1);
  const dvec2 corner = mesh.uv[0][0];
  const Box box = clipped_triangle_box(mesh, 0, corner + dvec2(0.2, 0.1), corner + dvec2(0.3, 0.2), {0, 0, 0});
  for (int k = 0; k < 2; ++k) EXPECT_NEAR(box.hi[k] - box.lo[k], 0.1, 1e-5);
  const Box none = clipped_triangle_box(mesh, 0, corner + dvec2(5, 5), corner + dvec2(6, 6), {0, 0, 0});
  EXPECT_GT(none.lo[0], none.hi[0]);
}

}  // namespace
}  // namespace wale::test
