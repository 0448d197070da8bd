#include "bench/wale_bench/measure.h"

#include <algorithm>
#include <memory>
#include <optional>

namespace wale::bench {
namespace {

// The same world whose plies let nothing through: leaves and codes of hits are those of the first one.
SceneDevice opaque_scene(const Device& device, World& world) {
  std::vector<float> tau;
  for (WPlyMaterial& m : world.ply_materials) tau.push_back(std::exchange(m.tau_e, -1.0f));
  SceneDevice scene(device, world);
  for (size_t i = 0; i < tau.size(); ++i) world.ply_materials[i].tau_e = tau[i];
  return scene;
}

double sum_of(const WaveCounts& counts, const char* kernel) {
  const auto found = counts.stages.find(kernel);
  return found == counts.stages.end() ? 0 : found->second.seconds;
}

}  // namespace

FabricResult measure(const Device& device, const Workload& workload, const Loaders& loaders, const DeviceRates& rates,
                     const MeasureOptions& options, const std::function<void(double)>& progress) {
  FabricResult out;
  out.name = workload.name;
  const double steps = 2.0 * options.repeats + 3;
  double done = 0;
  const auto step = [&] { progress(++done / steps); };

  World world = build_world(workload.scene, loaders);
  out.knit_seconds = world.seconds["knit"];
  step();

  std::unique_ptr<SceneDevice> scene;
  for (int k = 0; k < options.repeats; ++k, step()) {
    scene.reset();
    const Stopwatch watch;
    scene = std::make_unique<SceneDevice>(device, world);
    out.build_cpu.push_back(watch.seconds().cpu);
    const FabricDevice& fabric = scene->fabric();
    out.warp.push_back(fabric.warp_seconds);
    out.pack.push_back(fabric.pack_seconds);
    out.tree.push_back(fabric.build_seconds);
  }
  const FabricDevice& fabric = scene->fabric();
  out.segments = fabric.segment_count;
  out.patches = fabric.patch_count;
  out.nodes = fabric.node_count;
  const double segments = double(std::max<size_t>(1, out.segments));
  out.trace_bytes = double(fabric.tree.leaves.bytes() + fabric.tree.tree_bytes()) / segments;
  out.shade_bytes = out.trace_bytes + double(fabric.frames.bytes()) / segments;

  IntegratorScene integrator = workload.scene.integrator;
  integrator.local_stage = "exact";
  RenderOptions render_options;
  render_options.spp = integrator.spp;
  render_options.kernel_dir = options.kernel_dir;
  render_options.also = options.also;
  const Features features = features_of(device.traits(), world, integrator, render_options);

  RayRecord record;
  render_options.record = &record;
  const uint32_t pool = render(device, world, *scene, integrator, render_options).devices.front().pool;
  render_options.record = nullptr;
  render_options.count_cpu_time = device.traits().cpu;
  step();

  const SceneDevice opaque = opaque_scene(device, world);
  RayReplay attenuated_rays(device, world, *scene, features, record, pool, false, options.kernel_dir);
  RayReplay opaque_rays(device, world, opaque, features, record, pool, true, options.kernel_dir);
  std::map<std::string, std::vector<double>> in_render;
  WaveCounts counts;
  for (int k = 0; k < options.repeats + 1; ++k) {
    const Stopwatch watch;
    const Rendered r = render(device, world, *scene, integrator, render_options);
    const Seconds seconds = watch.seconds();
    attenuated_rays.repeat();
    opaque_rays.repeat();
    if (k == 0) continue;  // only warms up
    counts = r.counts;
    out.samples = r.counts.paths;
    out.render_wall.push_back(r.seconds);
    out.render_cpu.push_back(seconds.cpu);
    in_render["primary"].push_back(counts.primary_seconds);
    in_render["bounce"].push_back(counts.bounce_seconds());
    in_render["shadow"].push_back(sum_of(counts, "connect"));
    step();
  }

  const std::vector<RayRow> attenuated = attenuated_rays.finish(options.checked_rays);
  out.rays = opaque_rays.finish(options.checked_rays);
  out.rays.insert(out.rays.end(), attenuated.begin(), attenuated.end());
  TraversalCost path, shadow;
  uint64_t path_rays = 0;
  for (const RayRow& row : attenuated) {
    for (size_t k = 0; k < row.device.size(); ++k) {
      const double alone = device.traits().cpu ? row.cpu[k] / device.traits().compute_units : row.device[k];
      if (alone > 0) out.replay_over_render[row.name()].push_back(in_render[row.name()][k] / alone);
    }
    if (row.kind == RayKind::shadow) {
      shadow = {row.bytes, row.operations};
    } else {
      path.bytes += row.bytes * double(row.rays);
      path.operations += row.operations * double(row.rays);
      path_rays += row.rays;
    }
  }
  if (path_rays) path = {path.bytes / double(path_rays), path.operations / double(path_rays)};
  out.stages = profile_stages(features, counts, rates, path, shadow);
  out.ns_per_vertex = ns_per_vertex(counts);
  step();
  return out;
}

}  // namespace wale::bench
