#include "tests/kernels/fabric_tracer.h"

#include <fmt/format.h>

#include <ctime>
#include <type_traits>

#include "host/program.h"
#include "tests/kernels/trace_kernels.h"

namespace wale::test {
namespace {

// The arguments of the cell stages are there for every stage; the exact one does not read them.
constexpr const char* kKernels = R"(
#define PARAMS __global const uint* nodes, __global const uint* node_cell, __global const uint* leaves, \
    __global uint* counters, __global const float* base_positions, __global const uint* base_indices, \
    __global const float* base_uv, __global const uint* cell_triangle_offsets, __global const uint* cell_triangles, \
    __global const uint* cell_segment_offsets, __global const uint* cell_segments, __global const WGrid* grids, \
    __global const uint* grid_of_cell, __global const float* lattice, __global const uint* tiles, uint patch_bits, \
    __global const TestRay* rays, uint count SIMT LEAVES
#ifdef W_SIMT
#define SIMT , __global const uint* leaf_boxes
#define BOXES s.leaf_boxes = leaf_boxes;
#else
#define SIMT
#define BOXES
#endif
#ifdef W_SPLIT_LEAVES
#define LEAVES , __global const uint* leaves1, __global const uint* leaves2, __global const uint* leaves3, \
    __global const uint* leaves4, __global const uint* leaves5, __global const uint* leaves6, \
    __global const uint* leaves7, uint leaf_bits
#define SPLIT __global const uint* more[] = {leaves1, leaves2, leaves3, leaves4, leaves5, leaves6, leaves7}; \
    for (uint b = 0; b < W_LEAF_BUFFERS - 1; ++b) s.more_leaves[b] = more[b]; \
    s.leaf_bits = leaf_bits;
#else
#define LEAVES
#define SPLIT
#endif
#if W_LOCAL_STAGE
#define CELLS s.base_positions = base_positions; s.base_indices = base_indices; s.base_uv = base_uv; \
    s.cell_triangle_offsets = cell_triangle_offsets; s.cell_triangles = cell_triangles; \
    s.cell_segment_offsets = cell_segment_offsets; s.cell_segments = cell_segments; s.grids = grids; \
    s.grid_of_cell = grid_of_cell;
#else
#define CELLS
#endif
#ifdef W_HAS_PROCEDURAL
#define LATTICE s.lattice = lattice; s.tiles = tiles; s.patch_bits = patch_bits;
#else
#define LATTICE
#endif
#define SCENE WScene s; s.nodes = nodes; s.node_cell = node_cell; s.leaves = leaves; s.ply_root = 0; \
    s.tri_root = W_NONE; s.spheres_count = 0; s.counters = counters; CELLS LATTICE SPLIT BOXES
__kernel void trace(PARAMS, __global TestHit* hits) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  SCENE
  const WRay r = ray_of(rays + i);
  write_hit(&s, &r, hits + i);
}
__kernel void nearest(PARAMS, __global float* out) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  SCENE
  const WRay r = ray_of(rays + i);
  const WHit hit = w_closest(&s, &r);
  out[i] = (float)hit.t + (float)(hit.code & 1u);
}
__kernel void any_hit(PARAMS, __global float* out) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  SCENE
  const WRay r = ray_of(rays + i);
  out[i] = (float)w_occluded(&s, &r);
}
__kernel void surfaces(PARAMS, __global const TestHit* hits, __global const float* frames,
                       __global TestSurface* out) {
  const uint i = get_global_id(0);
  if (i >= count || hits[i].kind != W_HIT_PLY) return;
  SCENE
  const WRay r = ray_of(rays + i);
  write_surface(&s, frames, &r, hits + i, out + i);
}
)";

FabricDevice upload(const Device& device, const Fabric& fabric, float tau, LocalStage stage, bool updatable,
                    LeafForm form) {
  const FabricInput input{&fabric, 0, tau};
  return upload_fabrics(device, {&input, 1}, {0, 0, 0}, stage, updatable, form);
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

FabricTracer::FabricTracer(const Device& device, const Fabric& fabric, float tau, LocalStage stage, bool updatable,
                           LeafForm form)
    : device_(device),
      knit_(fabric),
      stage_(stage),
      fibres_(fabric.report.fibres > 0),
      procedural_(fabric.procedural),
      fabric_(upload(device, fabric, tau, stage, updatable, form)),
      leaves_(fabric_.tree.leaves.read(device)),
      counters_(device, W_EVENT_COUNT) {
  counters_.fill(device, 0);
}

cl::Kernel FabricTracer::bound(const char* name, const Buffer<Ray>& rays, size_t count, bool twice,
                               cl_uint* next) const {
  const bool simt = fabric_.tree.quantised.bytes() > 0;
  const std::string lanes = twice ? "-DW_DOUBLE -DW_LANES=1" : fmt::format("-DW_LANES={}", device_.traits().lanes);
  const std::string options =
      fmt::format("-DW_HAS_PLIES {} -DW_LOCAL_STAGE={}{}", lanes, int(stage_), fibres_ ? " -DW_HAS_FIBRES" : "") +
      (procedural_ ? " -DW_HAS_PROCEDURAL" : "") + (simt ? " -DW_SIMT" : "") +
      (fabric_.tree.leaves.split() ? " -DW_SPLIT_LEAVES" : "") +
      (fabric_.tree.form.quantised() ? " -DW_QUANTISED_VERTICES" : "");
  auto& program = programs_[twice];
  if (!program()) program = build_program_text(device_, std::string(kTraceTypes) + kKernels, options);
  cl::Kernel kernel(program, name);
  const FabricDevice& f = fabric_;
  cl_uint arg = 0;
  for (const cl::Buffer& buffer :
       {f.tree.ray_nodes().cl(), f.tree.node_cell.cl(), f.tree.leaves.parts().front().words.cl(), counters_.cl(),
        f.base_positions.cl(), f.base_indices.cl(), f.base_uv.cl(), f.cell_triangle_offsets.cl(), f.cell_triangles.cl(),
        f.cell_segment_offsets.cl(), f.cell_segments.cl(), f.grids.cl(), f.grid_of_cell.cl(), f.lattice.lattice.cl(),
        f.lattice.tiles.cl()})
    kernel.setArg(arg++, buffer);
  kernel.setArg(arg++, f.lattice.patch_bits);
  kernel.setArg(arg++, rays.cl());
  kernel.setArg(arg++, uint32_t(count));
  if (simt) kernel.setArg(arg++, f.tree.quantised.leaf_boxes().cl());
  if (f.tree.leaves.split()) arg = f.tree.leaves.bind_others(kernel, arg);
  *next = arg;
  return kernel;
}

template <typename Real>
std::vector<HitOf<Real>> FabricTracer::trace_as(const std::vector<Ray>& rays) const {
  const Buffer<Ray> in(device_, rays);
  const Buffer<HitOf<Real>> out(device_, rays.size());
  cl_uint own = 0;
  cl::Kernel kernel = bound("trace", in, rays.size(), std::is_same_v<Real, double>, &own);
  kernel.setArg(own, out.cl());
  device_.queue().enqueueNDRangeKernel(kernel, cl::NullRange, device_.global(rays.size()), device_.local());
  return out.read(device_);
}

template <typename Real>
std::vector<SurfaceOf<Real>> FabricTracer::surfaces_as(const std::vector<Ray>& rays,
                                                       const std::vector<HitOf<Real>>& hits) const {
  const Buffer<Ray> in(device_, rays);
  const Buffer<HitOf<Real>> hit_buffer(device_, hits);
  const Buffer<SurfaceOf<Real>> out(device_, rays.size());
  cl_uint own = 0;
  cl::Kernel kernel = bound("surfaces", in, rays.size(), std::is_same_v<Real, double>, &own);
  kernel.setArg(own, hit_buffer.cl());
  kernel.setArg(own + 1, fabric_.frames.cl());
  kernel.setArg(own + 2, out.cl());
  device_.queue().enqueueNDRangeKernel(kernel, cl::NullRange, device_.global(rays.size()), device_.local());
  return out.read(device_);
}

std::vector<Hit> FabricTracer::trace(const std::vector<Ray>& rays) const { return trace_as<float>(rays); }
std::vector<HitOf<double>> FabricTracer::trace_in_double(const std::vector<Ray>& rays) const {
  return trace_as<double>(rays);
}
std::vector<Surface> FabricTracer::surfaces(const std::vector<Ray>& rays, const std::vector<Hit>& hits) const {
  return surfaces_as(rays, hits);
}
std::vector<SurfaceOf<double>> FabricTracer::surfaces_in_double(const std::vector<Ray>& rays,
                                                                const std::vector<HitOf<double>>& hits) const {
  return surfaces_as(rays, hits);
}

double FabricTracer::seconds(const std::vector<Ray>& rays) const {
  const Buffer<Ray> in(device_, rays);
  const Buffer<float> out(device_, rays.size());
  cl_uint own = 0;
  cl::Kernel kernel = bound("nearest", in, rays.size(), false, &own);
  kernel.setArg(own, out.cl());
  cl::Event event;
  device_.queue().enqueueNDRangeKernel(kernel, cl::NullRange, device_.global(rays.size()), device_.local(), nullptr,
                                       &event);
  event.wait();
  return 1e-9 * double(event.getProfilingInfo<CL_PROFILING_COMMAND_END>() -
                       event.getProfilingInfo<CL_PROFILING_COMMAND_START>());
}

double FabricTracer::cpu_seconds(const std::vector<Ray>& rays, const char* name) const {
  const Buffer<Ray> in(device_, rays);
  const Buffer<float> out(device_, rays.size());
  cl_uint own = 0;
  cl::Kernel kernel = bound(name, in, rays.size(), false, &own);
  kernel.setArg(own, out.cl());
  const std::clock_t start = std::clock();
  device_.queue().enqueueNDRangeKernel(kernel, cl::NullRange, device_.global(rays.size()), device_.local());
  device_.queue().finish();
  return double(std::clock() - start) / CLOCKS_PER_SEC;
}

uint32_t FabricTracer::segment(uint32_t code) const {
  const uint32_t* leaf = leaves_.data() + size_t(code >> 4) * 4;
  const uint32_t n = leaf[W_LEAF_LAYOUT] & 255, lane = code & 15;
  return leaf[W_LEAF_SEGMENT] + lane % n * leaf[W_LEAF_STRIDE] + lane / n;
}

std::vector<float> FabricTracer::positions() const {
  const FabricInput input{&knit_, 0, -1};
  return FabricWarp(device_, {&input, 1}, {0, 0, 0}).points().read(device_);
}

std::vector<uint32_t> FabricTracer::events() const { return counters_.read(device_); }

}  // namespace wale::test
