// The price of the local stages: rays that `cell` and `cell+ring` get wrong, and the time that they take, against
// `exact`. Usage: local_stage [segments] [rays] [repeats]; needs an OpenCL device. A flat swatch and a tube in
// stockinette of 3 plies; primary rays from 30 degrees above the cloth or more, secondary rays from their hits into the
// outer hemisphere. Wrong: hit instead of miss or the other way round, or another segment more than 0.01 ply radii
// nearer or farther. Times: the device's own clock, the stages in turn, median of the ratios within each turn.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <random>

#include "geom/base_mesh_generators.h"
#include "tests/kernels/fabric_tracer.h"

namespace {

using namespace wale;
using namespace wale::test;

struct Cloth {
  const char* name;
  bool tube;
};

BaseMesh mesh_of(const Cloth& cloth, double size) {
  return cloth.tube ? make_tube(size / 6, size, 96, 16) : make_swatch(size, size, 8, 8);
}

Fabric knit(const Cloth& cloth, double segments) {
  FabricSpec spec;
  spec.name = cloth.name;
  spec.scale.kind = FabricScale::Kind::uv_metres;
  double size = 0.05;
  for (int pass = 0; pass < 4; ++pass)
    size *= std::sqrt(segments / double(estimate_segments(mesh_of(cloth, size), stockinette_pattern(), spec)));
  return knit_fabric(mesh_of(cloth, size), stockinette_pattern(), spec);
}

// Towards random points of the cloth from 30 to 90 degrees above it.
std::vector<Ray> primary_on(const Fabric& fabric, size_t count) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<double> area;
  const BaseMesh& mesh = fabric.mesh;
  for (const auto& t : mesh.triangle)
    area.push_back(
        glm::length(glm::cross(mesh.position[t[1]] - mesh.position[t[0]], mesh.position[t[2]] - mesh.position[t[0]])));
  std::discrete_distribution<size_t> choose(area.begin(), area.end());
  std::vector<Ray> rays;
  while (rays.size() < count) {
    const auto& t = mesh.triangle[choose(random)];
    double u = uniform(random), v = uniform(random);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const dvec3 a = mesh.position[t[0]], at = a + u * (mesh.position[t[1]] - a) + v * (mesh.position[t[2]] - a);
    const dvec3 n = glm::normalize(glm::cross(mesh.position[t[1]] - a, mesh.position[t[2]] - a));
    const dvec3 side = glm::normalize(glm::cross(n, std::abs(n.x) < 0.6 ? dvec3(1, 0, 0) : dvec3(0, 1, 0)));
    const double sine = 0.5 + 0.5 * uniform(random), turn = 2 * std::numbers::pi * uniform(random);
    const dvec3 flat = std::cos(turn) * side + std::sin(turn) * glm::cross(n, side);
    const dvec3 out = sine * n + std::sqrt(1 - sine * sine) * flat;
    rays.push_back(make_ray(at + 0.1 * out, -out, uint32_t(rays.size())));
  }
  return rays;
}

double share_wrong(const FabricTracer& exact, const FabricTracer& stage, const std::vector<Ray>& rays, double radius) {
  const std::vector<Hit> expected = exact.trace(rays), got = stage.trace(rays);
  size_t wrong = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    const bool hit = expected[i].kind == W_HIT_PLY;
    wrong +=
        hit != (got[i].kind == W_HIT_PLY) || (hit && exact.segment(expected[i].code) != stage.segment(got[i].code) &&
                                              std::abs(expected[i].t - got[i].t) > 1e-2 * radius);
  }
  return double(wrong) / double(rays.size());
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

double time_ratio(const FabricTracer& exact, const FabricTracer& stage, const std::vector<Ray>& rays, int repeats) {
  std::vector<double> ratios;
  for (int k = 0; k < repeats + 1; ++k) {
    const double a = exact.seconds(rays), b = stage.seconds(rays);
    if (k > 0) ratios.push_back(b / a);  // the first turn only warms up
  }
  return median(ratios);
}

}  // namespace

int main(int argc, char** argv) {
  const double segments = argc > 1 ? std::atof(argv[1]) : 1e5;
  const size_t count = argc > 2 ? size_t(std::atoll(argv[2])) : 400000;
  const int repeats = argc > 3 ? std::max(1, std::atoi(argv[3])) : 9;
  const Device& device = test_device();
  fmt::print("{}, {} {}, {} lanes, {} rays, median of {}\n\n", device.traits().name, device.traits().platform,
             device.traits().driver, device.traits().lanes, count, repeats);
  fmt::print(
      "| cloth | segments | cells | stage | wrong primary | wrong secondary | time primary | time secondary |\n"
      "|---|---|---|---|---|---|---|---|\n");
  for (const Cloth& cloth : {Cloth{"flat swatch", false}, Cloth{"tube", true}}) {
    const Fabric fabric = knit(cloth, segments);
    const FabricTracer exact(device, fabric);
    const std::vector<Ray> primary = primary_on(fabric, count);
    const std::vector<Hit> hits = exact.trace(primary);
    // A ray that starts on a segment names it by a code of the tree that it is traced in; all stages pack alike.
    const std::vector<Ray> secondary = bounce_rays(primary, hits, exact.surfaces(primary, hits), 2);
    for (const auto& [name, stage] : {std::pair("cell", LocalStage::cell), std::pair("cell+ring", LocalStage::ring)}) {
      const FabricTracer other(device, fabric, -1, stage);
      fmt::print("| {} | {} | {} | {} | {:.3f} % | {:.3f} % | x {:.2f} | x {:.2f} |\n", cloth.name,
                 exact.fabric().segment_count, exact.fabric().cell_count, name,
                 100 * share_wrong(exact, other, primary, fabric.ply_radius),
                 100 * share_wrong(exact, other, secondary, fabric.ply_radius),
                 time_ratio(exact, other, primary, repeats), time_ratio(exact, other, secondary, repeats));
    }
  }
}
