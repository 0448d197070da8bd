#include "tests/kernels/fabric_tracer.h"

#include <fmt/format.h>

#include "host/program.h"

namespace wale::test {
namespace {

// The arguments of the cell stages are there for every stage; the exact one does not read them.
constexpr const char* kKernels = R"(
#include "geometry/ply_surface.clh"
typedef struct TestRay { float o[3], l[3], d[3]; float tmax; uint key, skip, skip_triangle, pad; } TestRay;
typedef struct TestHit { float t; uint kind, code; float u, v; uint occluded; } TestHit;
typedef struct TestSurface {
  float anchor[3], x[3], n[3], t[3], smooth_n[3]; float phi, u, length, radius, h; uint segment;
} TestSurface;
#define PARAMS __global const uint* nodes, __global const uint* node_cell, __global const uint* leaves, \
    __global uint* counters, __global const float* base_positions, __global const uint* base_indices, \
    __global const float* base_uv, __global const uint* cell_triangle_offsets, __global const uint* cell_triangles, \
    __global const uint* cell_segment_offsets, __global const uint* cell_segments, __global const WGrid* grids, \
    __global const uint* grid_of_cell, __global const TestRay* rays, uint count
#if W_LOCAL_STAGE
#define CELLS s.base_positions = base_positions; s.base_indices = base_indices; s.base_uv = base_uv; \
    s.cell_triangle_offsets = cell_triangle_offsets; s.cell_triangles = cell_triangles; \
    s.cell_segment_offsets = cell_segment_offsets; s.cell_segments = cell_segments; s.grids = grids; \
    s.grid_of_cell = grid_of_cell;
#else
#define CELLS
#endif
#define SCENE WScene s; s.nodes = nodes; s.node_cell = node_cell; s.leaves = leaves; s.ply_root = 0; \
    s.tri_root = W_NONE; s.spheres_count = 0; s.counters = counters; CELLS
WRay ray_of(__global const TestRay* in) {
  WRay r;
  r.o = vload3(0, in->o);
  r.l = vload3(0, in->l);
  r.d = vload3(0, in->d);
  r.tmax = in->tmax;
  r.key = in->key;
  r.skip = in->skip;
  r.skip_triangle = in->skip_triangle;
  return r;
}
__kernel void trace(PARAMS, __global TestHit* hits) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  SCENE
  const WRay r = ray_of(rays + i);
  const WHit hit = w_closest(&s, &r);
  hits[i].t = hit.t;
  hits[i].kind = hit.kind;
  hits[i].code = hit.code;
  hits[i].u = hit.u;
  hits[i].v = hit.v;
  hits[i].occluded = w_occluded(&s, &r);
}
__kernel void nearest(PARAMS, __global float* out) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  SCENE
  const WRay r = ray_of(rays + i);
  const WHit hit = w_closest(&s, &r);
  out[i] = hit.t + (float)(hit.code & 1u);
}
__kernel void surfaces(PARAMS, __global const TestHit* hits, __global const float* vertices,
                       __global TestSurface* out) {
  const uint i = get_global_id(0);
  if (i >= count || hits[i].kind != W_HIT_PLY) return;
  SCENE
  const WRay r = ray_of(rays + i);
  WHit hit;
  hit.t = hits[i].t;
  hit.kind = hits[i].kind;
  hit.code = hits[i].code;
  hit.u = hits[i].u;
  hit.v = hits[i].v;
  const WPlySurface p = w_ply_surface(&s, vertices, &r, &hit);
  vstore3(p.anchor, 0, out[i].anchor);
  vstore3(p.x, 0, out[i].x);
  vstore3(p.n, 0, out[i].n);
  vstore3(p.t, 0, out[i].t);
  vstore3(p.smooth_n, 0, out[i].smooth_n);
  out[i].phi = p.phi;
  out[i].u = p.u;
  out[i].length = p.length;
  out[i].radius = p.radius;
  out[i].h = p.h;
  out[i].segment = p.segment;
}
)";

constexpr cl_uint kFirstOwn = 15;  // first argument behind PARAMS

FabricDevice upload(const Device& device, const Fabric& fabric, float tau, LocalStage stage) {
  const FabricInput input{&fabric, 0, tau};
  return upload_fabrics(device, {&input, 1}, {0, 0, 0}, stage);
}

}  // namespace

std::vector<PlyPatch> patches_of(const Fabric& fabric, float tau) {
  std::vector<PlyPatch> patches;
  for (const Patch& p : fabric.patches) {
    const PlyRun& run = fabric.runs[p.run];
    const bool fibre = run.kind == PlyRun::Kind::fibre;
    patches.push_back({run.first_vertex, run.count, p.first, p.intervals, run.plies, p.cell, 0,
                       fibre ? W_MATERIAL_FIBRE : 0, 0, run.radius, fibre ? -1.0f : tau, run.ghost_ends});
  }
  return patches;
}

FabricTracer::FabricTracer(const Device& device, const Fabric& fabric, float tau, LocalStage stage)
    : device_(device),
      stage_(stage),
      fibres_(fabric.report.fibres > 0),
      fabric_(upload(device, fabric, tau, stage)),
      leaves_(fabric_.tree.leaves.read(device)),
      counters_(device, W_EVENT_COUNT) {
  counters_.fill(device, 0);
}

cl::Kernel FabricTracer::bound(const char* name, const Buffer<Ray>& rays, size_t count) const {
  const std::string options = fmt::format("-DW_HAS_PLIES -DW_LANES={} -DW_LOCAL_STAGE={}{}", device_.traits().lanes,
                                          int(stage_), fibres_ ? " -DW_HAS_FIBRES" : "");
  cl::Kernel kernel(build_program_text(device_, kKernels, options), name);
  const FabricDevice& f = fabric_;
  cl_uint arg = 0;
  for (const cl::Buffer& buffer :
       {f.tree.nodes.cl(), f.tree.node_cell.cl(), f.tree.leaves.cl(), counters_.cl(), f.base_positions.cl(),
        f.base_indices.cl(), f.base_uv.cl(), f.cell_triangle_offsets.cl(), f.cell_triangles.cl(),
        f.cell_segment_offsets.cl(), f.cell_segments.cl(), f.grids.cl(), f.grid_of_cell.cl(), rays.cl()})
    kernel.setArg(arg++, buffer);
  kernel.setArg(arg++, uint32_t(count));
  return kernel;
}

std::vector<Hit> FabricTracer::trace(const std::vector<Ray>& rays) const {
  const Buffer<Ray> in(device_, rays);
  const Buffer<Hit> out(device_, rays.size());
  cl::Kernel kernel = bound("trace", in, rays.size());
  kernel.setArg(kFirstOwn, out.cl());
  device_.queue().enqueueNDRangeKernel(kernel, cl::NullRange, device_.global(rays.size()), device_.local());
  return out.read(device_);
}

std::vector<Surface> FabricTracer::surfaces(const std::vector<Ray>& rays, const std::vector<Hit>& hits) const {
  const Buffer<Ray> in(device_, rays);
  const Buffer<Hit> hit_buffer(device_, hits);
  const Buffer<Surface> out(device_, rays.size());
  cl::Kernel kernel = bound("surfaces", in, rays.size());
  kernel.setArg(kFirstOwn, hit_buffer.cl());
  kernel.setArg(kFirstOwn + 1, fabric_.vertices.cl());
  kernel.setArg(kFirstOwn + 2, out.cl());
  device_.queue().enqueueNDRangeKernel(kernel, cl::NullRange, device_.global(rays.size()), device_.local());
  return out.read(device_);
}

double FabricTracer::seconds(const std::vector<Ray>& rays) const {
  const Buffer<Ray> in(device_, rays);
  const Buffer<float> out(device_, rays.size());
  cl::Kernel kernel = bound("nearest", in, rays.size());
  kernel.setArg(kFirstOwn, out.cl());
  cl::Event event;
  device_.queue().enqueueNDRangeKernel(kernel, cl::NullRange, device_.global(rays.size()), device_.local(), nullptr,
                                       &event);
  event.wait();
  return 1e-9 * double(event.getProfilingInfo<CL_PROFILING_COMMAND_END>() -
                       event.getProfilingInfo<CL_PROFILING_COMMAND_START>());
}

uint32_t FabricTracer::segment(uint32_t code) const {
  const uint32_t* leaf = leaves_.data() + size_t(code >> 4) * 4;
  const uint32_t n = leaf[W_LEAF_LAYOUT] & 255, lane = code & 15;
  return leaf[W_LEAF_SEGMENT] + lane % n * leaf[W_LEAF_STRIDE] + lane / n;
}

uint32_t FabricTracer::stack_overflows() const { return counters_.read(device_)[W_EVENT_STACK_FULL]; }

}  // namespace wale::test
