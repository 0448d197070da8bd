#include "bench/wale_bench/score.h"

#include <cmath>

namespace wale::bench {
namespace {

// v1, 22 November 2026: two cores of an AVX-512 EPYC under PoCL 3.1; bench/results/history.
const std::map<std::string, double> kReferenceSpeeds = {
    {"primary", 7.23}, {"bounce", 1.99}, {"shadow", 2.25}, {"attenuated shadow", 2.34}, {"render", 230}};

}  // namespace

double counted_seconds(const Device& device, const std::vector<double>& by_device, const std::vector<double>& cpu) {
  return device.traits().cpu ? median(cpu) / device.traits().compute_units : median(by_device);
}

TileMeans render_picture(const Device& device, int spp, uint32_t seed, const std::filesystem::path& kernel_dir) {
  const Scene scene = frozen_picture_scene();
  const World world = build_world(scene, {});
  const SceneDevice on_device(device, world);
  IntegratorScene integrator = scene.integrator;
  integrator.seed = seed;
  RenderOptions options;
  options.spp = spp ? spp : integrator.spp;
  options.kernel_dir = kernel_dir;
  return tile_means(render(device, world, on_device, integrator, options).image);
}

PictureCheck check_picture(const Device& device, const std::filesystem::path& kernel_dir) {
  return compare_tiles(reference_picture(), render_picture(device, 0, 0, kernel_dir));
}

Score score_of(const Device& device, const FabricResult& result, const PictureCheck& picture) {
  Score s;
  s.picture = picture;
  s.verified = picture.same;
  for (const RayRow& row : result.rays) {
    s.verified = s.verified && row.verified();
    if (row.attenuated && row.kind != RayKind::shadow) continue;
    s.speeds[(row.attenuated ? "attenuated " : "") + row.name()] =
        1e-6 * double(row.rays) / counted_seconds(device, row.device, row.cpu);
  }
  s.speeds["render"] = 1e-3 * double(result.samples) / counted_seconds(device, result.render_wall, result.render_cpu);
  double logs = 0;
  for (const auto& [name, speed] : kReferenceSpeeds) logs += std::log(s.speeds[name] / speed);
  s.score = 100 * std::exp(logs / double(kReferenceSpeeds.size()));
  return s;
}

}  // namespace wale::bench
