#include "tests/kernels/synthetic.h"

#include <chrono>
#include <cmath>
#include <ctime>
#include <map>
#include <numbers>

#include "host/program.h"
#include "shared/visits.h"
#include "tests/kernels/trace_kernels.h"

namespace wale::test {
namespace {

using std::numbers::pi;

constexpr const char* kTrace = R"(
#if W_LANES == 16
#include "geometry/traverse_packet.clh"
#endif
#include "stages/ask_ahead.clh"
#define PARAMS __global const uint* nodes, __global const uint* leaves, uint root, __global uint* counters, \
    __global const uint* leaf_boxes
W_INLINE WScene scene_of(PARAMS) {
  WScene s;
#ifdef W_SIMT
  s.leaf_boxes = leaf_boxes;
#endif
  s.nodes = nodes;
  s.leaves = leaves;
  s.ply_root = root;
  s.tri_root = W_NONE;
  s.spheres_count = 0;
  s.counters = counters;
  return s;
}
/* As the renderer's stages do. */
W_INLINE void ask_ahead(const WScene* s, __global const TestRay* rays, uint i, uint count) {
  const uint skip = rays[min(i + W_STARTS_AHEAD, count - 1u)].skip;
  if (skip != W_NONE) w_ask_for_whole(s, skip);
}
__kernel void trace(PARAMS, __global const TestRay* rays, __global TestHit* hits, uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  const WScene s = scene_of(nodes, leaves, root, counters, leaf_boxes);
  const WRay r = ray_of(rays + i);
  write_hit(&s, &r, hits + i);
}
#if W_LANES == 16
/* Traces the rays of work-item i together; returns how many they are. */
uint trace_packet(const WScene* s, __global const TestRay* rays, uint count, uint first, WPacket* packet) {
  const uint own = min(count - first, (uint)W_LANES);
  WRay alone[W_LANES];
  for (uint i = 0; i < own; ++i) alone[i] = ray_of(rays + first + i);
  w_closest_packet(s, alone, own, packet);
  return own;
}
__kernel void trace_packets(PARAMS, __global const TestRay* rays, __global TestHit* hits, uint count) {
  const uint first = get_global_id(0) * W_LANES;
  if (first >= count) return;
  const WScene s = scene_of(nodes, leaves, root, counters, leaf_boxes);
  WPacket packet;
  const uint own = trace_packet(&s, rays, count, first, &packet);
  for (uint i = 0; i < own; ++i) {
    const WHit hit = w_packet_hit(&packet, i);
    hits[first + i].t = hit.t;
    hits[first + i].kind = hit.kind;
    hits[first + i].code = hit.code;
    hits[first + i].u = hit.u;
    hits[first + i].v = hit.v;
    hits[first + i].occluded = 0;
  }
}
__kernel void closest_packets(PARAMS, __global const TestRay* rays, __global float* out, uint count) {
  const uint first = get_global_id(0) * W_LANES;
  if (first >= count) return;
  const WScene s = scene_of(nodes, leaves, root, counters, leaf_boxes);
  WPacket packet;
  const uint own = trace_packet(&s, rays, count, first, &packet);
  for (uint i = 0; i < own; ++i) {
    const WHit hit = w_packet_hit(&packet, i);
    out[2 * (first + i)] = (float)hit.t;
    out[2 * (first + i) + 1] = as_float(hit.code);
  }
}
#endif
__kernel void closest(PARAMS, __global const TestRay* rays, __global float* out, uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  const WScene s = scene_of(nodes, leaves, root, counters, leaf_boxes);
  ask_ahead(&s, rays, i, count);
  const WRay r = ray_of(rays + i);
  const WHit hit = w_closest(&s, &r);
  out[2 * i] = (float)hit.t;
  out[2 * i + 1] = as_float(hit.code);
}
__kernel void occluded(PARAMS, __global const TestRay* rays, __global float* out, uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  const WScene s = scene_of(nodes, leaves, root, counters, leaf_boxes);
  ask_ahead(&s, rays, i, count);
  const WRay r = ray_of(rays + i);
  out[i] = w_occluded(&s, &r);
}
__kernel void surfaces(PARAMS, __global const TestRay* rays, __global const TestHit* hits, uint count,
                       __global const float* frames, __global TestSurface* out) {
  const uint i = get_global_id(0);
  if (i >= count || hits[i].kind != W_HIT_PLY) return;
  const WScene s = scene_of(nodes, leaves, root, counters, leaf_boxes);
  const WRay r = ray_of(rays + i);
  write_surface(&s, frames, &r, hits + i, out + i);
}
)";

const cl::Program& program(const std::string& options) {
  static std::map<std::string, cl::Program> built;
  auto& program = built[options];
  if (!program())
    program = build_program_text(test_device(), std::string(kTraceTypes) + kTrace, "-DW_HAS_PLIES " + options);
  return program;
}

dvec3 unit(dvec3 a) { return glm::length(a) > 0 ? glm::normalize(a) : dvec3(1, 0, 0); }

// The tracer has both forms of the tree, whatever the device's own traversal.
Device by_lanes(Device device) {
  device.traits().traversal = Traversal::lanes;
  return device;
}

WideTree words_only(std::vector<uint32_t> words) {
  WideTree tree;
  tree.words = std::move(words);
  return tree;
}

constexpr const char* kDoubleBuild = "-DW_DOUBLE -DW_LANES=1";

}  // namespace

const Device& test_device() {
  static const Device device = Device::open();
  return device;
}

void Strands::add(uint32_t plies, uint32_t count, float radius,
                  const std::function<dvec3(uint32_t, uint32_t)>& position, bool ghosts, uint32_t patches_per_cell) {
  const uint32_t first = uint32_t(positions.size() / 3);
  for (uint32_t p = 0; p < plies; ++p) {
    double length = 0;
    dvec3 normal(0), last_tangent(0);
    for (uint32_t i = 0; i < count; ++i) {
      const dvec3 x = position(p, i);
      if (i > 0) length += glm::length(x - position(p, i - 1));
      const dvec3 before = i > 0 ? unit(x - position(p, i - 1)) : dvec3(0);
      const dvec3 after = i + 1 < count ? unit(position(p, i + 1) - x) : dvec3(0);
      const dvec3 tangent = unit(before + after);
      if (i == 0)
        normal = unit(glm::cross(tangent, std::abs(tangent.x) < 0.6 ? dvec3(1, 0, 0) : dvec3(0, 1, 0)));
      else if (1 + glm::dot(last_tangent, tangent) > 1e-6)
        normal -= glm::dot(normal, tangent) / (1 + glm::dot(last_tangent, tangent)) * (last_tangent + tangent);
      normal = unit(normal - glm::dot(normal, tangent) * tangent);
      last_tangent = tangent;
      for (int k = 0; k < 3; ++k) positions.push_back(float(x[k]));
      for (int k = 0; k < 3; ++k) frames.push_back(float(normal[k]));
      frames.push_back(float(length));
    }
  }
  const uint32_t intervals = W_LEAF_LANES / plies;
  const uint32_t begin = ghosts ? 1 : 0, end = ghosts ? count - 2 : count - 1;
  for (uint32_t k = begin, n = 0; k < end; k += intervals, ++n) {
    if (n % patches_per_cell == 0) ++next_cell;
    patches.push_back({first, count, k, std::min(intervals, end - k), plies, next_cell, 0, 0, 0, radius, tau, ghosts});
  }
}

size_t Strands::segments() const {
  size_t n = 0;
  for (const PlyPatch& p : patches) n += p.intervals * p.plies;
  return n;
}

Strands helix(uint32_t steps_per_turn, uint32_t turns, double helix_radius, double pitch, float radius) {
  Strands s;
  s.add(1, steps_per_turn * turns + 1, radius, [&](uint32_t, uint32_t i) {
    const double a = 2 * pi * i / steps_per_turn;
    return dvec3(helix_radius * std::cos(a), helix_radius * std::sin(a), pitch * a / (2 * pi));
  });
  return s;
}

Strands random_strands(uint32_t strands, uint32_t count, double step, double cube, float radius, uint32_t seed) {
  Strands s;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (uint32_t strand = 0; strand < strands; ++strand) {
    std::vector<dvec3> points;
    dvec3 x = 0.5 * cube * dvec3(uniform(random), uniform(random), uniform(random));
    dvec3 d = unit({uniform(random), uniform(random), uniform(random)});
    for (uint32_t i = 0; i < count; ++i) {
      points.push_back(x);
      d = unit(d + 0.9 * dvec3(uniform(random), uniform(random), uniform(random)));
      x += step * (1.05 + uniform(random)) * d;
    }
    s.add(1, count, radius, [&](uint32_t, uint32_t i) { return points[i]; });
  }
  return s;
}

Strands stockinette(uint32_t rows, uint32_t loops, uint32_t steps_per_loop, double scale, double bend) {
  Strands s;
  const uint32_t count = loops * steps_per_loop + 1;
  const double yarn = 0.62, ply = 0.29;  // in loop units
  for (uint32_t row = 0; row < rows; ++row)
    s.add(3, count, float(ply * scale), [&](uint32_t p, uint32_t i) {
      const double t = 2 * pi * i / steps_per_loop;
      const auto axis = [&](double at) {
        return dvec3(at + 1.5 * std::sin(2 * at), 4 * std::cos(at) + 4.4 * row, std::cos(2 * at));
      };
      const dvec3 tangent = unit(axis(t + 1e-4) - axis(t - 1e-4)), side = unit(glm::cross(tangent, dvec3(0, 0, 1)));
      const dvec3 up = glm::cross(side, tangent);
      const double twist = 2 * t + 2 * pi * p / 3;
      const dvec3 flat = axis(t) + (yarn - ply) * (std::cos(twist) * side + std::sin(twist) * up);
      const double angle = flat.x / bend, radius = bend + flat.z;
      return scale * dvec3(radius * std::sin(angle), flat.y, radius * std::cos(angle) - bend);
    });
  return s;
}

Tracer::Tracer(const Device& device, const Strands& strands, LeafForm form)
    : device_(device),
      frames_(device, strands.frames),
      tree_(build_ply_tree(by_lanes(device), strands.patches, Buffer<float>(device, strands.positions), {}, false, {},
                           form)),
      quantised_(device, words_only(tree_.nodes.read(device)), tree_.nodes),
      leaves_(tree_.leaves.read(device)),
      counters_(device, W_COUNTER_COUNT) {
  counters_.fill(device, 0);
}

cl::Kernel Tracer::bound(const std::string& options, const char* name, const Buffer<Ray>& rays) const {
  cl::Kernel kernel(program(options + (tree_.form.quantised() ? " -DW_QUANTISED_VERTICES" : "")), name);
  const bool simt = options.find("W_SIMT") != std::string::npos;
  kernel.setArg(0, simt ? quantised_.nodes().cl() : tree_.nodes.cl());
  kernel.setArg(1, tree_.leaves.cl());
  kernel.setArg(2, tree_.root);
  kernel.setArg(3, counters_.cl());
  kernel.setArg(4, quantised_.leaf_boxes().cl());
  kernel.setArg(5, rays.cl());
  return kernel;
}

template <typename Real>
std::vector<HitOf<Real>> Tracer::trace_as(const std::vector<Ray>& rays, const std::string& options, const char* name,
                                          size_t rays_per_item) {
  const Buffer<Ray> in(device_, rays);
  const Buffer<HitOf<Real>> out(device_, rays.size());
  cl::Kernel kernel = bound(options, name, in);
  kernel.setArg(6, out.cl());
  kernel.setArg(7, uint32_t(rays.size()));
  const size_t items = (rays.size() + rays_per_item - 1) / rays_per_item;
  device_.queue().enqueueNDRangeKernel(kernel, cl::NullRange, device_.global(items), device_.local());
  return out.read(device_);
}

std::vector<Hit> Tracer::trace_packets(const std::vector<Ray>& rays) {
  return trace_as<float>(rays, "-DW_LANES=16", "trace_packets", W_NODE_WIDTH);
}
std::vector<Hit> Tracer::trace(const std::vector<Ray>& rays, const std::string& options) {
  return trace_as<float>(rays, options);
}
std::vector<HitOf<double>> Tracer::trace_in_double(const std::vector<Ray>& rays) {
  return trace_as<double>(rays, kDoubleBuild);
}

double Tracer::time(const std::vector<Ray>& rays, const std::string& options, const std::string& name, double* wall) {
  const Buffer<Ray> in(device_, rays);
  const Buffer<float> out(device_, 2 * rays.size());
  cl::Kernel kernel = bound(options, name.c_str(), in);
  kernel.setArg(6, out.cl());
  kernel.setArg(7, uint32_t(rays.size()));
  const size_t rays_per_item = name == "closest_packets" ? W_NODE_WIDTH : 1;
  const size_t items = (rays.size() + rays_per_item - 1) / rays_per_item;
  const auto wall_start = std::chrono::steady_clock::now();
  const std::clock_t start = std::clock();
  device_.queue().enqueueNDRangeKernel(kernel, cl::NullRange, device_.global(items), device_.local());
  device_.queue().finish();
  const double cpu = double(std::clock() - start) / CLOCKS_PER_SEC;
  if (wall) *wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_start).count();
  return cpu;
}

template <typename Real>
std::vector<SurfaceOf<Real>> Tracer::surfaces_as(const std::vector<Ray>& rays, const std::vector<HitOf<Real>>& hits,
                                                 const std::string& options) {
  const Buffer<Ray> in(device_, rays);
  const Buffer<HitOf<Real>> hit_buffer(device_, hits);
  const Buffer<SurfaceOf<Real>> out(device_, rays.size());
  cl::Kernel kernel = bound(options, "surfaces", in);
  kernel.setArg(6, hit_buffer.cl());
  kernel.setArg(7, uint32_t(rays.size()));
  kernel.setArg(8, frames_.cl());
  kernel.setArg(9, out.cl());
  device_.queue().enqueueNDRangeKernel(kernel, cl::NullRange, device_.global(rays.size()), device_.local());
  return out.read(device_);
}

std::vector<Surface> Tracer::surfaces(const std::vector<Ray>& rays, const std::vector<Hit>& hits,
                                      const std::string& options) {
  return surfaces_as(rays, hits, options);
}
std::vector<SurfaceOf<double>> Tracer::surfaces_in_double(const std::vector<Ray>& rays,
                                                          const std::vector<HitOf<double>>& hits) {
  return surfaces_as(rays, hits, kDoubleBuild);
}

uint32_t Tracer::segment(uint32_t code) const {
  const uint32_t* leaf = leaves_.data() + size_t(code >> 4) * 4;
  const uint32_t n = leaf[W_LEAF_LAYOUT] & 255, lane = code & 15;
  return leaf[W_LEAF_SEGMENT] + lane % n * leaf[W_LEAF_STRIDE] + lane / n;
}

std::vector<uint32_t> Tracer::events() const { return counters_.read(device_); }

Ray make_ray(dvec3 origin, dvec3 direction, uint32_t key) {
  Ray ray;
  direction = unit(direction);
  for (int k = 0; k < 3; ++k) {
    ray.o[k] = float(origin[k]);
    ray.d[k] = float(direction[k]);
  }
  ray.key = key;
  return ray;
}

std::vector<Ray> primary_rays(const Box& bounds, size_t count, uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0, 1);
  const dvec3 lo(bounds.lo[0], bounds.lo[1], bounds.lo[2]), hi(bounds.hi[0], bounds.hi[1], bounds.hi[2]);
  std::vector<Ray> rays;
  for (size_t i = 0; i < count; ++i) {
    const dvec3 target = lo + (hi - lo) * dvec3(uniform(random), uniform(random), uniform(random));
    const dvec3 eye = 0.5 * (lo + hi) + glm::length(hi - lo) * unit({normal(random), normal(random), normal(random)});
    rays.push_back(make_ray(eye, target - eye, uint32_t(i)));
  }
  return rays;
}

std::vector<Ray> bounce_rays(const std::vector<Ray>& rays, const std::vector<Hit>& hits,
                             const std::vector<Surface>& surfaces, uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::vector<Ray> out;
  for (size_t i = 0; i < rays.size(); ++i) {
    if (hits[i].kind != W_HIT_PLY) continue;
    const Surface& s = surfaces[i];
    dvec3 d = unit({normal(random), normal(random), normal(random)});
    const dvec3 n(s.n[0], s.n[1], s.n[2]);
    if (glm::dot(d, n) < 0) d = -d;
    Ray ray = make_ray(dvec3(s.anchor[0], s.anchor[1], s.anchor[2]), d, uint32_t(i) * 7 + 1);
    for (int k = 0; k < 3; ++k) ray.l[k] = s.x[k];
    ray.skip = hits[i].code;
    out.push_back(ray);
  }
  return out;
}

}  // namespace wale::test
