// Throughput of the traversal alone: stockinette of 3-ply yarns on a bent sheet, primary, shadow and bounce rays.
// Usage: traverse_bench [segments] [rays per side]; needs an OpenCL device. Prints million rays per CPU-second and
// core (median of five launches), node and leaf bytes.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <random>

#include "host/program.h"
#include "tests/kernels/synthetic.h"

namespace {

using namespace wale;
using namespace wale::test;

// Z-order index to pixel: neighbours in the list are neighbours on the film.
uint32_t every_second_bit(uint32_t x) {
  uint32_t out = 0;
  for (int k = 0; k < 16; ++k) out |= (x >> (2 * k) & 1u) << k;
  return out;
}

double million_per_second(const Device& device, Tracer& tracer, const std::vector<Ray>& rays, const char* kernel) {
  tracer.time(rays, "-DW_LANES=" + std::to_string(device.traits().lanes), kernel);
  std::vector<double> seconds;
  for (int k = 0; k < 5; ++k)
    seconds.push_back(tracer.time(rays, "-DW_LANES=" + std::to_string(device.traits().lanes), kernel));
  std::sort(seconds.begin(), seconds.end());
  return double(rays.size()) / seconds[2] * 1e-6;
}

}  // namespace

int main(int argc, char** argv) {
  const double wanted = argc > 1 ? std::atof(argv[1]) : 1e6;
  const uint32_t side = argc > 2 ? uint32_t(std::atoi(argv[2])) : 512;
  const uint32_t steps = 56;  // per 2 pi: two stitches
  const double stitches = wanted / (3 * 28), loops = std::sqrt(stitches / 2 * 4.4 / 6.283);
  const Strands cloth = stockinette(uint32_t(stitches / 2 / loops), uint32_t(loops), steps, 0.01, 400);
  const Device& device = test_device();
  Tracer tracer(device, cloth);
  const Box& b = tracer.tree().bounds;
  fmt::print("{}: {} segments, {} patches, {} nodes, {:.1f} B a segment, pack {:.3f} s, tree {:.3f} s\n",
             device.traits().name, cloth.segments(), cloth.patches.size(), tracer.tree().node_cell.count(),
             double(tracer.tree().leaves.bytes() + tracer.tree().nodes.bytes()) / double(cloth.segments()),
             tracer.tree().pack_seconds, tracer.tree().build_seconds);
  std::vector<Ray> primary;
  const dvec3 lo(b.lo[0], b.lo[1], b.lo[2]), hi(b.hi[0], b.hi[1], b.hi[2]), middle = 0.5 * (lo + hi);
  const dvec3 eye = middle + dvec3(0.1, -0.2, 1.2) * glm::length(hi - lo);
  for (uint32_t i = 0; i < side * side; ++i) {
    const dvec3 target(lo.x + (hi.x - lo.x) * (every_second_bit(i) + 0.5) / side,
                       lo.y + (hi.y - lo.y) * (every_second_bit(i >> 1) + 0.5) / side, middle.z);
    primary.push_back(make_ray(eye, target - eye, i));
  }
  const std::vector<Hit> hits = tracer.trace(primary, "-DW_LANES=" + std::to_string(device.traits().lanes));
  const std::vector<Ray> bounce = bounce_rays(primary, hits, tracer.surfaces(primary, hits), 1);
  fmt::print(
      "hit {:.1f} %, primary {:.2f}, bounce {:.2f}, shadow of bounce rays {:.2f} Mrays per CPU-second\n",
      100.0 * double(bounce.size()) / double(primary.size()), million_per_second(device, tracer, primary, "closest"),
      million_per_second(device, tracer, bounce, "closest"), million_per_second(device, tracer, bounce, "occluded"));
}
