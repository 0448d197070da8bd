#include <fmt/format.h>

#include <chrono>

#include "geom/error.h"
#include "host/atomic_file.h"
#include "host/commands.h"
#include "host/progress.h"
#include "host/rare_events.h"
#include "host/render.h"
#include "host/stop.h"

namespace wale {
namespace {

// "WxH" into the film's size.
void apply_size(const std::string& size, FilmScene& film) {
  int w = 0, h = 0, end = 0;
  if (std::sscanf(size.c_str(), "%dx%d%n", &w, &h, &end) != 2 || size_t(end) != size.size() || w < 1 || h < 1 ||
      w > 65536 || h > 65536)
    user_error("--size {}: expected WIDTHxHEIGHT, each 1 to 65536, for example 768x768", size);
  film.width = w;
  film.height = h;
}

Stats stats_of(const Scene& scene, const Device& device, const World& world, const SceneDevice& on_device,
               const Features& features, const Rendered& r) {
  Stats s;
  s.scene = scene.file;
  s.device = device.traits().name;
  s.driver = device.traits().driver;
  s.platform = device.traits().platform;
  s.kernel_options = device.traits().build_options;
  for (const auto& reason : explain(world, scene.integrator, features))
    if (reason.used) s.features.push_back(reason.feature);
  for (const auto& [name, seconds] : r.counts.program_seconds) s.programs.push_back({name, seconds, false});
  uint64_t segments = 0, vertices = 0;
  for (const auto& f : world.fabrics) segments += f.report.segments, vertices += f.report.vertices;
  const auto bytes = on_device.bytes();
  s.geometry["ply segments"] = {segments, bytes.at("ply leaves") + bytes.at("ply tree") + bytes.at("lattices")};
  s.geometry["ply vertices"] = {vertices, bytes.at("ply vertices")};
  s.geometry["triangles"] = {world.triangle_count(), bytes.at("triangles")};
  s.geometry["path state"] = {r.pool, r.path_bytes};
  s.stage_seconds = world.seconds;
  s.stage_seconds["warp"] = on_device.fabric().warp_seconds;
  s.stage_seconds["pack leaves"] = on_device.fabric().pack_seconds;
  s.stage_seconds["build tree"] = on_device.fabric().build_seconds;
  for (const auto& [name, stage] : r.counts.stages) s.stage_seconds[name] = stage.seconds;
  const auto seconds = [&](const char* stage) {
    const auto found = r.counts.stages.find(stage);
    return found == r.counts.stages.end() ? 0.0 : found->second.seconds;
  };
  // Primary and bounce rays share the intersect stage; its time is split by their numbers.
  const double path_rays = double(r.counts.primary + r.counts.bounce);
  const double per_ray = path_rays > 0 ? seconds("intersect") / path_rays : 0;
  s.rays["primary"] = {r.counts.primary, per_ray * double(r.counts.primary)};
  s.rays["bounce"] = {r.counts.bounce, per_ray * double(r.counts.bounce)};
  s.rays["shadow"] = {r.counts.shadow, seconds("connect")};
  for (const RareEvent& e : kRareEvents) s.rare_events[e.name] = r.counts.events[e.counter];
  s.width = world.camera.width;
  s.height = world.camera.height;
  s.samples = r.counts.paths;
  s.samples_per_pixel = r.samples;
  s.total_seconds = r.seconds;
  return s;
}

}  // namespace

int run_render(const RenderArgs& args, const Loaders& loaders) {
  Scene scene = read_scene(args.scene, args.set);
  if (!args.size.empty()) apply_size(args.size, scene.film);
  // Everything that can be refused is refused before the long work starts.
  bool aovs = false;
  for (const auto& output : args.outputs) {
    require_writable(output);
    aovs |= output.extension() == ".exr";
  }
  if (!args.stats.empty()) require_writable_path(args.stats);
  const Device device = Device::open(args.device);
  catch_stop_signals();

  World world;
  {
    Progress bar("knit", args.quiet);
    world = build_world(scene, loaders, [&](const std::string&, double fraction) { bar.update(fraction); });
    bar.finish();
  }
  if (!args.quiet)
    for (const auto& note : world.notes) fmt::print(stderr, "note: {}\n", note);
  const SceneDevice on_device(device, world, local_stage(scene.integrator));
  RenderOptions options;
  options.spp = args.spp > 0 ? args.spp : scene.integrator.spp;
  if (args.seconds > 0 && args.spp == 0) options.spp = 1 << 20;  // the clock decides
  options.seconds = args.seconds;
  options.aovs = aovs;
  options.kernel_dir = args.kernel_dir;
  Progress bar("render", args.quiet);
  const Rendered r = render(device, world, on_device, scene.integrator, options, [&](double f) { bar.update(f); });
  bar.finish(r.stopped ? "stopped early" : "");

  for (const auto& output : args.outputs) write_image(r.image, output, scene.film.exposure, scene.film.view);
  const Features features = analyse(world, scene.integrator, aovs, int(device.traits().lanes));
  const Stats stats = stats_of(scene, device, world, on_device, features, r);
  if (!args.stats.empty()) write_stats(stats, args.stats);
  const double rays = double(r.counts.primary + r.counts.bounce + r.counts.shadow);
  if (!args.quiet)
    fmt::print(stderr, "{} samples per pixel in {}, {:.2f} Mrays/s\n", r.samples, duration_text(r.seconds),
               1e-6 * rays / r.seconds);
  for (const RareEvent& e : kRareEvents)
    if (const uint64_t count = r.counts.events[e.counter];
        count && e.weight == RareEvent::Weight::warning && !args.quiet)
      fmt::print(stderr, "warning: {}: {} times\n", e.name, count);
  if (const uint64_t count = r.counts.events[W_EVENT_NAN])
    bug("render: {} samples were not finite; the picture was written without them", count);
  return 0;
}

}  // namespace wale
