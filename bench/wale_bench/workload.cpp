#include "bench/wale_bench/workload.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/world.h"

namespace wale::bench {
namespace {

constexpr double kFrozenSize = 0.2;         // metres of cloth
constexpr double kFrozenSegments = 0.95e6;  // about as many that it has
constexpr int kFrozenSide = 512, kPictureSide = 48, kPictureSamples = 64;

// `size` metres of cloth over a ball; everything else follows from it, except the yarn.
Scene draped_cloth(const std::string& name, double size, int side, int spp) {
  const std::string text = fmt::format(
      R"({{"wale": 1,
 "camera": {{"position": [{}, {}, {}], "look_at": [0, 0, 0], "up": [0, 0, 1], "fov": 26}},
 "film": {{"size": [{}, {}]}},
 "integrator": {{"spp": {}}},
 "materials": {{"yarn": {{"type": "ply", "preset": "wool", "color": [0.7, 0.45, 0.2]}}}},
 "fabrics": [{{"name": "cloth", "mesh": {{"generator": "draped_square", "size": {}, "sphere_radius": {}, "nu": {}}},
  "pattern": {{"builtin": "stockinette"}}, "gauge": {{"wales": 40}},
  "yarn": {{"plies": 3, "twist_pitch": 8}}, "tolerance": 0.25, "material": "yarn"}}],
 "lights": [{{"type": "sphere", "position": [{}, {}, {}], "radius": {}, "radiance": 40}},
  {{"type": "environment", "radiance": 0.3, "up": [0, 0, 1]}}]}}
)",
      0.4 * size, -1.55 * size, 1.15 * size, side, side, spp, size, 0.35 * size, std::clamp(int(320 * size), 16, 512),
      -1.25 * size, -1.25 * size, 2.25 * size, 0.3 * size);
  return parse_scene(text, name);
}

constexpr int kMostSamples = 16, kSceneSamples = 8;

int samples_of(uint64_t rays, int side) {
  return int(std::clamp<uint64_t>(rays / (uint64_t(side) * uint64_t(side)), 1, kMostSamples));
}

}  // namespace

Workload frozen_workload(uint32_t pool) {
  return {kFrozenName, draped_cloth(kFrozenName, kFrozenSize, kFrozenSide, samples_of(pool, kFrozenSide)), true};
}

Workload cloth_workload(double segments, uint64_t rays) {
  const int side = std::clamp(int(std::sqrt(double(rays))), 8, kFrozenSide);
  double size = kFrozenSize * std::sqrt(segments / kFrozenSegments);
  for (int pass = 0; pass < 3; ++pass) {
    const Scene scene = draped_cloth("cloth", size, side, 1);
    const FabricScene& fabric = scene.fabrics.front();
    const double have =
        double(estimate_segments(load_mesh(fabric.mesh, {}), load_pattern(fabric.pattern), fabric.spec));
    size *= std::sqrt(segments / std::max(1.0, have));
  }
  const std::string name = fmt::format("{:.6g} segments", segments);
  return {name, draped_cloth(name, size, side, samples_of(rays, side))};
}

Workload scene_workload(const Scene& scene, uint64_t rays) {
  Workload w{scene.file, scene};
  FilmScene& film = w.scene.film;
  int& spp = w.scene.integrator.spp;
  spp = std::min(kSceneSamples, spp);
  const double scale = std::sqrt(std::min(1.0, double(rays) / (double(film.width) * film.height * spp)));
  film.width = std::max(8, int(film.width * scale));
  film.height = std::max(8, int(film.height * scale));
  return w;
}

Scene frozen_picture_scene() { return draped_cloth(kFrozenName, kFrozenSize, kPictureSide, kPictureSamples); }

}  // namespace wale::bench
