#include <fmt/format.h>

#include <chrono>
#include <future>
#include <memory>

#include "geom/error.h"
#include "host/atomic_file.h"
#include "host/command_frames.h"
#include "host/commands.h"
#include "host/image_coder.h"
#include "host/memory_needs.h"
#include "host/output_names.h"
#include "host/progress.h"
#include "host/rare_events.h"
#include "host/rehearsal.h"
#include "host/render.h"
#include "host/sampling_report.h"
#include "host/scene_identity.h"
#include "host/stats.h"
#include "host/stop.h"

namespace wale {
namespace {

// The devices of a render and the scene on each of them.
class Devices {
 public:
  explicit Devices(const std::string& text) {
    for (const unsigned number : device_numbers(text)) open_.push_back(Device::open(number));
  }

  // At the same time: each device warps, packs and builds its own tree, as its rounding may be its own.
  void upload(const World& world, const IntegratorScene& integrator, const RenderOptions& options) {
    for (const Device& device : open_) {
      const DeviceTraits& traits = device.traits();
      const Features features = features_of(traits, world, integrator, options);
      require_memory(device, memory_needs(world, features, pool_of(traits, integrator, options), traits));
    }
    std::vector<std::future<std::unique_ptr<SceneDevice>>> scenes;
    for (const Device& device : open_)
      scenes.push_back(std::async(open_.size() > 1 ? std::launch::async : std::launch::deferred,
                                  [&] { return std::make_unique<SceneDevice>(device, world); }));
    for (auto& scene : scenes) scenes_.push_back(scene.get());
    for (size_t d = 0; d < open_.size(); ++d) list_.push_back({&open_[d], scenes_[d].get()});
  }

  const std::vector<Device>& open() const { return open_; }
  const std::vector<RenderDevice>& list() const { return list_; }

 private:
  std::vector<Device> open_;
  std::vector<std::unique_ptr<SceneDevice>> scenes_;
  std::vector<RenderDevice> list_;
};

// Wall seconds of the steps that lead to the first sample.
class Start {
 public:
  void step(const std::string& name) {
    const double now = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
    steps_.emplace_back(name, now - last_);
    last_ = now;
  }
  void step(const std::string& name, double seconds) {
    steps_.emplace_back(name, seconds);
    last_ += seconds;
  }
  double seconds() const { return last_; }
  const std::vector<std::pair<std::string, double>>& steps() const { return steps_; }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  double last_ = 0;
  std::vector<std::pair<std::string, double>> steps_;
};

Stats stats_of(const Scene& scene, const World& world, const std::vector<RenderDevice>& devices,
               const Features& features, const Rendered& r, bool programs_cached) {
  Stats s;
  s.scene = scene.file;
  const Device& first = *devices.front().device;
  const SceneDevice& on_first = *devices.front().scene;
  s.device = first.traits().name;
  s.driver = first.traits().driver;
  s.platform = first.traits().platform;
  s.kernel_options = first.traits().build_options;
  for (const auto& reason : explain(world, scene.integrator, features))
    if (reason.used) s.features.push_back(reason.feature);
  for (const auto& [name, seconds] : r.counts.program_seconds) s.programs.push_back({name, seconds, programs_cached});
  uint64_t segments = 0, vertices = 0, pool = 0, path_bytes = 0;
  for (const auto& f : world.fabrics) segments += f.report.segments, vertices += f.report.vertices;
  for (size_t d = 0; d < devices.size(); ++d) {
    const DeviceShare& share = r.devices[d];
    const DeviceTraits& traits = devices[d].device->traits();
    pool += share.pool, path_bytes += share.path_bytes;
    s.devices.push_back({traits.name, traits.driver, devices[d].device->number(), share.counts.paths,
                         share.counts.primary + share.counts.bounce + share.counts.shadow, share.moved_blocks,
                         share.busy_seconds});
  }
  const auto bytes = on_first.bytes();
  s.geometry["ply segments"] = {segments, bytes.at("ply leaves") + bytes.at("ply tree") + bytes.at("lattices")};
  s.geometry["ply vertices"] = {vertices, bytes.at("ply vertices")};
  s.geometry["triangles"] = {world.triangle_count(), bytes.at("triangles")};
  s.geometry["path state"] = {pool, path_bytes};
  s.stage_seconds = world.seconds;
  s.stage_seconds["warp"] = on_first.fabric().warp_seconds;
  s.stage_seconds["pack leaves"] = on_first.fabric().pack_seconds;
  s.stage_seconds["build tree"] = on_first.fabric().build_seconds;
  for (const auto& [name, stage] : r.counts.stages) s.stage_seconds[name] = stage.seconds;
  s.rates = measure_rates(first);
  s.stages = profile_stages(features, r.counts, s.rates);
  s.ns_per_vertex = ns_per_vertex(r.counts);
  const auto seconds = [&](const char* stage) {
    const auto found = r.counts.stages.find(stage);
    return found == r.counts.stages.end() ? 0.0 : found->second.seconds;
  };
  s.rays["primary"] = {r.counts.primary, r.counts.primary_seconds};
  s.rays["bounce"] = {r.counts.bounce, r.counts.bounce_seconds()};
  s.rays["shadow"] = {r.counts.shadow, seconds("connect")};
  for (const RareEvent& e : kRareEvents) s.rare_events[e.name] = r.counts.events[e.counter];
  s.width = world.camera.width;
  s.height = world.camera.height;
  s.samples = r.counts.paths;
  s.samples_per_pixel = r.reached.mean;
  s.total_seconds = r.seconds;
  return s;
}

}  // namespace

int most_samples(const RenderArgs& args, const IntegratorScene& integrator) {
  constexpr int kTowardsError = 65536, kTowardsTime = 1 << 20;
  if (args.error > 0 && args.spp > 0 && args.spp < int(kScrambles))
    user_error(
        "--error {:g} with --spp {}: noise is measured between {} samples and more of a pixel; valid: --spp {} or "
        "more, or none",
        args.error, args.spp, kScrambles, kScrambles);
  if (args.spp > 0) return args.spp;
  return args.error > 0 ? kTowardsError : args.seconds > 0 ? kTowardsTime : integrator.spp;
}

int run_render(const RenderArgs& args, const Loaders& loaders) {
  Start start;
  Scene scene = read_scene(args);
  if (!args.frames.empty() || scene.animation.shutter > 0) return run_frames(args, loaders);
  if (args.redo || !args.video.empty())
    user_error("--{}: of an animation; give --frames too, for example --frames 0..47", args.redo ? "redo" : "video");
  if (!args.size.empty()) apply_size(args.size, scene.film);
  // Everything that can be refused is refused before the long work starts.
  const int spp = most_samples(args, scene.integrator);
  bool aovs = false;
  OutputNames names;
  if (!args.stats.empty()) names.add(args.stats);
  for (const auto& output : args.outputs) {
    require_writable(output);
    names.add(output);
    aovs |= is_exr(output);
  }
  if (!args.stats.empty()) require_writable_path(args.stats);
  const auto named = named_devices(args.device);
  start.step("read the scene");
  // Programs are compiled while the scene is knitted.
  Rehearsal rehearsal(args.device, [&](const DeviceTraits& traits) {
    const Features features = foresee(scene, aovs, traits).with(args.also);
    auto stages = geometry_stages(features);
    for (auto& stage : wavefront_stages(features)) stages.push_back(std::move(stage));
    return Rehearsal::Plan{stages, features.options(), args.kernel_dir};
  });
  const auto knit = [&] {
    Progress bar("knit", args.quiet);
    World made = build_world(scene, loaders, [&](const std::string&, double fraction) { bar.update(fraction); });
    bar.finish();
    return made;
  };
  // So are the devices opened: their drivers bring large libraries. Devices that there may not be come first: a long
  // knit cannot be left.
  const bool sure = !named || *named == std::vector<unsigned>{0};
  std::future<World> knitted = std::async(sure ? std::launch::async : std::launch::deferred, knit);
  Devices devices(args.device);
  rehearsal.begin(devices.open());
  start.step("open devices");
  const World world = knitted.get();
  if (!args.quiet)
    for (const auto& note : world.notes) fmt::print(stderr, "note: {}\n", note);
  start.step("knit");
  RenderOptions options;
  options.spp = spp;
  options.error = args.error;
  options.seconds = args.seconds;
  options.aovs = aovs;
  options.also = args.also;
  options.kernel_dir = args.kernel_dir;
  options.ready = catch_stop_signals;  // before the first ray there is nothing to keep
  devices.upload(world, scene.integrator, options);
  start.step("warp and tree");
  if (const uint32_t tight = devices.list().front().scene->fabric().tight_joints; tight > 0 && !args.quiet)
    fmt::print(stderr, "note: {} joints bend too tightly to be warped where rays meet them: their fabrics are stored\n",
               tight);
  Progress bar("render", args.quiet);
  Rendered r = render(devices.list(), world, scene.integrator, options, [&](double f) {
    if (!args.outputs.empty()) image_coder();  // if it cannot be loaded, now rather than when all is rendered
    bar.update(f);
  });
  bar.finish(r.stopped ? "stopped early" : "");
  start.step("programs", r.program_seconds);
  start.step("first wave", r.first_sample_seconds);

  const SamplingReport sampling{options.spp, options.error, options.seconds, r.stopped, r.reached};
  r.image.figures = sampling_attributes(sampling);
  r.image.attributes = {{kSceneAttribute, scene_identity(args.scene, args.set)},
                        {kAccuracyAttribute, accuracy_settings(scene)}};
  for (const auto& output : args.outputs) write_image(r.image, output, scene.film.exposure, scene.film.view);
  const Features features = features_of(devices.list().front().device->traits(), world, scene.integrator, options);
  if (!args.stats.empty()) {
    Stats stats = stats_of(scene, world, devices.list(), features, r, rehearsal.cached());
    stats.first_sample_seconds = start.seconds();
    stats.start = start.steps();
    stats.sampling = sampling;
    write_stats(stats, args.stats);
  }
  if (!stop_requested()) rehearsal.finish();  // a render shorter than that would leave it to each one after it
  const double rays = double(r.counts.primary + r.counts.bounce + r.counts.shadow);
  if (!args.quiet)
    fmt::print(stderr, "{} in {}, {:.2f} Mrays/s\n", samples_text(r.reached), duration_text(r.seconds),
               1e-6 * rays / r.seconds);
  if (const std::string text = goal_text(sampling); !text.empty() && !args.quiet) fmt::print(stderr, "{}\n", text);
  for (const RareEvent& e : kRareEvents)
    if (const uint64_t count = r.counts.events[e.counter];
        count && e.weight == RareEvent::Weight::warning && !args.quiet)
      fmt::print(stderr, "warning: {}: {} times\n", e.name, count);
  if (const uint64_t count = r.counts.events[W_EVENT_NAN])
    bug("render: {} samples were not finite; the picture was written without them", count);
  return 0;
}

}  // namespace wale
