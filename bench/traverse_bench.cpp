// Throughput of the traversal alone. Usage: traverse_bench [segments] [rays per side]; needs an OpenCL device. Prints
// million rays per CPU-second and core (median of five launches), node and leaf bytes.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "bench/cloth_rays.h"

namespace {

using namespace wale;
using namespace wale::test;

double million_per_second(Tracer& tracer, const std::vector<Ray>& rays, const std::string& options,
                          const char* kernel) {
  tracer.time(rays, options, kernel);
  std::vector<double> seconds;
  for (int k = 0; k < 5; ++k) seconds.push_back(tracer.time(rays, options, kernel));
  std::sort(seconds.begin(), seconds.end());
  return double(rays.size()) / seconds[2] * 1e-6;
}

}  // namespace

int main(int argc, char** argv) {
  const double wanted = argc > 1 ? std::atof(argv[1]) : 1e6;
  const uint32_t side = argc > 2 ? uint32_t(std::atoi(argv[2])) : 512;
  const Strands cloth = bench::cloth(wanted);
  const Device& device = test_device();
  const std::string options = fmt::format("-DW_LANES={}", device.traits().lanes);
  Tracer tracer(device, cloth);
  fmt::print("{}: {} segments, {} patches, {} nodes, {:.1f} B a segment, pack {:.3f} s, tree {:.3f} s\n",
             device.traits().name, cloth.segments(), cloth.patches.size(), tracer.tree().node_cell.count(),
             double(tracer.tree().leaves.bytes() + tracer.tree().tree_bytes()) / double(cloth.segments()),
             tracer.tree().pack_seconds, tracer.tree().build_seconds);
  const bench::ClothRays rays = bench::cloth_rays(tracer, side, options);
  fmt::print("hit {:.1f} %, primary {:.2f}, bounce {:.2f}, shadow {:.2f} Mrays per CPU-second\n",
             100.0 * double(rays.bounce.size()) / double(rays.primary.size()),
             million_per_second(tracer, rays.primary, options, "closest"),
             million_per_second(tracer, rays.bounce, options, "closest"),
             million_per_second(tracer, rays.shadow, options, "occluded"));
}
