// Two versions of the kernels, stage by stage. Usage: stage_compare OLD_KERNELS NEW_KERNELS [segments] [repeats]; needs
// an OpenCL device. Both folders' kernels take the same arguments and as many hits an item (host/stages.cpp). The cloth of wale_bench is rendered with one and the
// other in turn, each launch waited for: CPU nanoseconds an item over the device's cores, median of the ratios within
// each turn, and how far apart the pictures are.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <exception>
#include <map>

#include "bench/wale_bench/clock.h"
#include "bench/wale_bench/workload.h"
#include "geom/error.h"
#include "host/compare.h"
#include "host/render.h"
#include "host/world.h"

namespace {

using namespace wale;

constexpr uint64_t kRays = 1 << 18;

void compare(const std::filesystem::path& before, const std::filesystem::path& after, double segments, int repeats) {
  const bench::Workload workload = bench::cloth_workload(segments, kRays);
  const Device device = Device::open(0);
  const World world = build_world(workload.scene, {});
  const SceneDevice scene(device, world);
  RenderOptions options;
  options.spp = workload.scene.integrator.spp;
  options.count_cpu_time = true;

  const std::array folders{before, after};
  std::map<std::string, std::array<std::vector<double>, 2>> ns;
  std::array<Image, 2> pictures;
  for (int k = 0; k <= repeats; ++k)
    for (size_t side = 0; side < 2; ++side) {
      options.kernel_dir = folders[side];
      const Rendered r = render(device, world, scene, workload.scene.integrator, options);
      pictures[side] = r.image;
      if (k == 0) continue;  // only warms up
      for (const auto& [stage, time] : r.counts.stages)
        if (time.items) ns[stage][side].push_back(1e9 * time.seconds / double(time.items));
    }

  fmt::print("{}, {:.2f}M segments, {} samples a pixel, {} turns\n", device.traits().name,
             double(scene.fabric().segment_count) * 1e-6, options.spp, repeats);
  for (auto& [stage, sides] : ns) {
    std::vector<double> ratio;
    for (size_t k = 0; k < sides[0].size(); ++k) ratio.push_back(sides[0][k] / sides[1][k]);
    std::sort(ratio.begin(), ratio.end());
    fmt::print("{:18} {:8.1f} {:8.1f} ns, {:.3f} times as fast ({:.3f} to {:.3f})\n", stage, bench::median(sides[0]),
               bench::median(sides[1]), bench::median(ratio), ratio.front(), ratio.back());
  }
  const CompareReport c = compare_images(pictures[0], pictures[1]);
  fmt::print("pictures: RMSE {:.3g}, largest difference {:.3g}, mean green {:.6g} and {:.6g}\n", c.rmse, c.largest,
             c.mean_a[1], c.mean_b[1]);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    fmt::print(stderr, "stage_compare OLD_KERNELS NEW_KERNELS [segments] [repeats]\n");
    return 1;
  }
  try {
    compare(argv[1], argv[2], argc > 3 ? std::atof(argv[3]) : 1e6, argc > 4 ? std::max(1, std::atoi(argv[4])) : 5);
  } catch (const Error& e) {
    fmt::print(stderr, "stage_compare: {}\n", e.what());
    return static_cast<int>(e.fault());
  }
}
