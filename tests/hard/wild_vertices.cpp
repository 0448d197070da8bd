#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>

#include "geom/error.h"
#include "host/program.h"
#include "tests/hard/wild_numbers.h"

namespace wale::test {
namespace {

// Nearest hit by trying every leaf: what a tree must never be slower than.
constexpr const char* kEveryLeaf = R"(
#include "geometry/traverse.clh"
__kernel void every_leaf(__global const uint* leaves, __global const uint* offsets, uint leaf_count,
                         __global uint* counters, __global const float* rays, __global float* out, uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  WScene s;
  s.leaves = leaves;
  s.counters = counters;
  __global const float* in = rays + 7 * i;
  WRay r;
  r.o = (w_real3)(in[0], in[1], in[2]);
  r.l = (w_real3)(0);
  r.d = (w_real3)(in[3], in[4], in[5]);
  r.tmax = in[6];
  r.key = i;
  r.skip = r.skip_triangle = W_NONE;
  WHit hit;
  hit.t = r.tmax;
  hit.kind = W_HIT_NONE;
  hit.code = W_NONE;
  for (uint leaf = 0; leaf < leaf_count; ++leaf)
    w_leaf_plies(&s, &r, offsets[leaf], 0xffffu, 0, &hit, 0, w_is_unit(&r));
  out[i] = hit.t;
}
)";

double seconds_of_every_leaf(const Tracer& tracer, const std::vector<Ray>& rays) {
  static const cl::Program program = build_program_text(test_device(), kEveryLeaf, "-DW_HAS_PLIES -DW_LANES=16");
  const Device& device = test_device();
  std::vector<float> flat;
  for (const Ray& ray : rays) {
    flat.insert(flat.end(), ray.o, ray.o + 3);
    flat.insert(flat.end(), ray.d, ray.d + 3);
    flat.push_back(ray.tmax);
  }
  const Buffer<float> in(device, flat), out(device, rays.size());
  const Buffer<uint32_t> offsets(device, tracer.tree().leaf_offset), counters(device, W_EVENT_COUNT);
  cl::Kernel kernel(program, "every_leaf");
  kernel.setArg(0, tracer.tree().leaves.cl());
  kernel.setArg(1, offsets.cl());
  kernel.setArg(2, uint32_t(tracer.tree().leaf_offset.size()));
  kernel.setArg(3, counters.cl());
  kernel.setArg(4, in.cl());
  kernel.setArg(5, out.cl());
  kernel.setArg(6, uint32_t(rays.size()));
  const std::clock_t start = std::clock();
  device.queue().enqueueNDRangeKernel(kernel, cl::NullRange, device.global(rays.size()), device.local());
  device.queue().finish();
  return double(std::clock() - start) / CLOCKS_PER_SEC;
}

/// Random bits of at most `limit`, denormals and zeros among them.
float random_bits(std::mt19937& random, float limit) {
  for (;;) {
    const float x = random_finite(random);
    if (std::abs(x) <= limit) return x;
  }
}

/// Plies whose coordinates and radii are random bits, or a scene of size 1 in which one coordinate in 16 is.
Strands wild_plies(bool all, float limit, std::mt19937& random) {
  Strands wild;
  for (uint32_t strand = 0; strand < 120; ++strand)
    wild.add(1 + strand % 8, 12, all ? std::abs(random_bits(random, limit)) : 0.01f, [&](uint32_t, uint32_t) {
      dvec3 x;
      for (int k = 0; k < 3; ++k)
        x[k] = all || random() % 16 == 0 ? random_bits(random, limit) : double(random()) / 0x1p32;
      return x;
    });
  return wild;
}

bool refused(const Strands& strands) {
  try {
    const Tracer tracer(test_device(), strands);
    return false;
  } catch (const Error& error) {
    return error.fault() == Fault::user && std::string(error.what()).find('\n') == std::string::npos;
  }
}

}  // namespace

Finding look_at_vertices_of_random_bits() {
  Finding f;
  f.error_float = 0;
  std::mt19937 random(27);
  // Any box of mitres about a vertex stays within twice its coordinate and four radii.
  constexpr float kLimit = kLargestCoordinate / 8;
  for (const bool all : {true, false}) {
    if (!refused(wild_plies(all, std::numeric_limits<float>::max(), random)))
      f.broken = "plies beyond what a float can place were not refused";
    Tracer tracer(test_device(), wild_plies(all, kLimit, random));
    std::vector<Ray> rays = primary_rays(Box{{0, 0, 0}, {1, 1, 1}}, 2000, 28);
    for (const Ray& far : primary_rays(Box{{-kLimit, -kLimit, -kLimit}, {kLimit, kLimit, kLimit}}, 2000, 29))
      rays.push_back(far);
    const std::vector<Hit> hits = tracer.trace(rays, "-DW_LANES=16");
    size_t met = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
      f.error_float += !bounded(rays[i], hits[i]);
      met += hits[i].kind != W_HIT_NONE;
    }
    if (!all && met == 0) f.broken = "no ray meets any of them";
    f.trials += rays.size();
    double tree = 1e30, every = 1e30;
    for (int repeat = 0; repeat < 2; ++repeat) {
      tree = std::min(tree, tracer.time(rays, "-DW_LANES=16", "closest"));
      every = std::min(every, seconds_of_every_leaf(tracer, rays));
    }
    if (tree > every) f.broken = fmt::format("{:.3g} s through the tree, {:.3g} s through every leaf", tree, every);
    f.rare += tracer.stack_overflows();
  }
  return f;
}

}  // namespace wale::test
