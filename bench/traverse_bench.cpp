// The traversal alone, by vectors of the device's width and by one ray per work-item down quantised nodes: bytes a
// segment, what a ray visits, and speed. Usage: traverse_bench [segments] [rays per side]; needs an OpenCL device.
// Million rays per CPU-second and core: medians of five launches, the two taking turns.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "bench/cloth_rays.h"
#include "shared/visits.h"

namespace {

using namespace wale;
using namespace wale::test;

struct Form {
  std::string name, options;
  size_t tree_bytes = 0;
};

struct Rays {
  const char* name;
  const std::vector<Ray>& rays;
  const char* kernel;
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

void print_visits(Tracer& tracer, const Form& form, const Rays& set) {
  const auto before = tracer.events();
  tracer.time(set.rays, form.options + " -DW_COUNT_VISITS", set.kernel);
  const auto after = tracer.events();
  const auto visits = [&](uint32_t what) { return double(after[what] - before[what]) / double(set.rays.size()); };
  fmt::print(
      "  {:8} {:20} nodes {:5.2f}, again {:5.2f}, leaf boxes {:5.2f}, leaves {:5.2f}, segments one by one {:5.2f}\n",
      set.name, form.name, visits(W_VISIT_NODE), visits(W_VISIT_AGAIN), visits(W_VISIT_BOX), visits(W_VISIT_LEAF),
      visits(W_VISIT_SEGMENT));
}

void print_speed(Tracer& tracer, const std::vector<Form>& forms, const Rays& set) {
  std::vector<double> seconds[2], ratio;
  for (int k = 0; k < 6; ++k) {
    double now[2];
    for (int f = 0; f < 2; ++f) now[f] = tracer.time(set.rays, forms[size_t(f)].options, set.kernel);
    if (k == 0) continue;  // the first compiles
    for (int f = 0; f < 2; ++f) seconds[f].push_back(now[f]);
    ratio.push_back(now[0] / now[1]);
  }
  fmt::print("  {:8}", set.name);
  for (int f = 0; f < 2; ++f)
    fmt::print(" {} {:.3f},", forms[size_t(f)].name, double(set.rays.size()) / median(seconds[f]) * 1e-6);
  fmt::print(" ratio {:.3f}\n", median(ratio));
}

}  // namespace

int main(int argc, char** argv) {
  const double wanted = argc > 1 ? std::atof(argv[1]) : 1e6;
  const uint32_t side = argc > 2 ? uint32_t(std::atoi(argv[2])) : 512;
  const Strands cloth = bench::cloth(wanted);
  const Device& device = test_device();
  Tracer tracer(device, cloth);
  const std::vector<Form> forms = {
      {"vectors", fmt::format("-DW_LANES={}", device.traits().lanes), tracer.tree().tree_bytes()},
      {"one ray per item", "-DW_LANES=1 -DW_SIMT", tracer.quantised().bytes()}};
  const double segments = double(cloth.segments());
  fmt::print("{}: {} segments, {} patches, {} nodes, pack {:.3f} s, tree {:.3f} s\n", device.traits().name,
             cloth.segments(), cloth.patches.size(), tracer.tree().node_count, tracer.tree().pack_seconds,
             tracer.tree().build_seconds);
  for (const Form& form : forms)
    fmt::print("{}: leaves {:.1f} B a segment, nodes and leaf boxes {:.2f}\n", form.name,
               double(tracer.tree().leaves.bytes()) / segments, double(form.tree_bytes) / segments);
  const bench::ClothRays rays = bench::cloth_rays(tracer, side, forms[0].options);
  fmt::print("hit {:.1f} %\n", 100.0 * double(rays.bounce.size()) / double(rays.primary.size()));
  const Rays sets[] = {
      {"primary", rays.primary, "closest"}, {"bounce", rays.bounce, "closest"}, {"shadow", rays.shadow, "occluded"}};
  fmt::print("visits a ray\n");
  for (const Rays& set : sets)
    for (const Form& form : forms) print_visits(tracer, form, set);
  fmt::print("Mrays per CPU-second\n");
  for (const Rays& set : sets) print_speed(tracer, forms, set);
}
