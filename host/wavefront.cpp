#include "host/wavefront.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <future>

#include "geom/error.h"
#include "host/program.h"
#include "host/stages.h"

namespace wale {
namespace {

constexpr uint32_t kChunk = 256;       // W_CHUNK of compact.cl
constexpr uint32_t kDepthCap = 65536;  // no path is this long; reaching it is counted as an event

template <typename... Args>
void set_args(cl::Kernel& kernel, cl_uint first, const Args&... args) {
  cl_uint index = first;
  (kernel.setArg(index++, args), ...);
}

/// Width of a pixel on what the camera sees: x metres, and y metres more per metre of distance.
cl_float2 pixel_width(const WCamera& camera) {
  const float film = 2 * camera.half_height / float(camera.height);
  return camera.kind == 1 ? cl_float2{{film, 0}} : cl_float2{{0, film}};
}

}  // namespace

Wavefront::Wavefront(const Device& device, const SceneDevice& scene, const Features& features, const WCamera& camera,
                     uint32_t pool, const std::filesystem::path& kernel_dir)
    : device_(device),
      scene_(&scene),
      features_(features),
      camera_(camera),
      kernel_dir_(kernel_dir),
      pool_(std::max(64u, pool)),
      film_(device, camera.width, camera.height, features.four_vectors()) {
  const auto vec = [&](Buffer<w_float4>& buffer, size_t count) {
    buffer = Buffer<w_float4>(device_, count);
    bytes_ += buffer.bytes();
  };
  const auto ints = [&](Buffer<uint32_t>& buffer, size_t count) {
    buffer = Buffer<uint32_t>(device_, count);
    bytes_ += buffer.bytes();
  };
  for (auto* b :
       {&ray_o_, &ray_l_, &ray_d_, &weight_, &hit_, &radiance_, &shadow_o_, &shadow_l_, &shadow_d_, &shadow_c_})
    vec(*b, pool_);
  hit_uv_ = Buffer<std::array<float, 2>>(device_, pool_);
  bytes_ += hit_uv_.bytes();
  for (auto* b :
       {&mask_, &active_[0], &active_[1], &ply_list_, &surface_list_, &miss_list_, &shadow_list_, &spare_list_})
    ints(*b, pool_);
  ints(fibre_list_, features_.fibres ? pool_ : 0);
  ints(chunk_, (pool_ / kChunk + 1) * bins());
  ints(queue_counts_, kQueueCounts);
  ints(tiles_, pool_ / kTilePixels);
  vec(aov_, features_.four_vectors() ? size_t(pool_) * 4 : 0);
  vec(score_, features_.gradients ? size_t(pool_) * W_GRADIENT_COUNT : 0);
  vec(shadow_gradient_, features_.gradients ? size_t(pool_) * W_GRADIENT_COUNT : 0);
  build_programs();
}

cl_uint Wavefront::bind_path(cl::Kernel& k, cl_uint first) const {
  set_args(k, first, ray_o_.cl(), ray_l_.cl(), ray_d_.cl(), weight_.cl(), hit_.cl(), hit_uv_.cl(), radiance_.cl(),
           shadow_o_.cl(), shadow_l_.cl(), shadow_d_.cl(), shadow_c_.cl(), mask_.cl(), tiles_.cl());
  if (!features_.gradients) return first + 13;
  set_args(k, first + 13, score_.cl(), shadow_gradient_.cl(), aov_.cl());
  return first + 16;
}

void Wavefront::bind_intersect(const char* name) {
  scene_->bind_scene(kernel(name), bind_path(kernel(name), 1), features_.procedural);
}

void Wavefront::take_packets() {
  if (!waiting_ || is_being_compiled(device_, waiting_->file, options_, kernel_dir_)) return;
  const cl::Program program = build_program(device_, waiting_->file, options_, kernel_dir_);
  kernels_["intersect_packets"] = cl::Kernel(program, "intersect_packets");
  bind_intersect("intersect_packets");
  waiting_.reset();
}

void Wavefront::build_programs() {
  options_ = features_.options() + scene_->options();
  auto programs = programs_of(wavefront_stages(features_), device_.traits().compiles_at_launch);
  const auto wait = std::find_if(programs.begin(), programs.end(), [&](const StageProgram& program) {
    return program.can_wait && is_being_compiled(device_, program.file, options_, kernel_dir_);
  });
  if (wait != programs.end()) {
    waiting_ = *wait;
    programs.erase(wait);
  }

  // One thread per program, where the driver bears it: compilation is the whole of the start-up time.
  const auto policy = device_.traits().parallel_builds ? std::launch::async : std::launch::deferred;
  using Clock = std::chrono::steady_clock;
  std::vector<std::future<std::pair<cl::Program, double>>> builds;
  for (const auto& one : programs)
    builds.push_back(std::async(policy, [&, file = one.file] {
      const auto start = Clock::now();
      cl::Program program = build_program(device_, file, options_, kernel_dir_);
      return std::pair(program, std::chrono::duration<double>(Clock::now() - start).count());
    }));
  for (size_t i = 0; i < programs.size(); ++i) {
    auto [program, seconds] = builds[i].get();
    counts_.program_seconds[programs[i].file] = seconds;
    for (const auto& name : programs[i].kernels) kernels_[name] = cl::Kernel(program, name.c_str());
  }

  bind();
}

bool Wavefront::serves(const SceneDevice& scene, const Features& features) const {
  return features.options() + scene.options() == options_;
}

void Wavefront::rebind(const SceneDevice& scene, const Features& features, const WCamera& camera, bool keep_film) {
  if (!serves(scene, features) || camera.width != camera_.width || camera.height != camera_.height)
    bug("wavefront: bound to a scene or a picture that it was not made for");
  harvest_events();
  scene_ = &scene;
  features_ = features;
  camera_ = camera;
  if (!keep_film) film_.clear(device_);
  bind();
}

void Wavefront::leave_scene() {
  const auto events = scene_->read_events();
  for (size_t i = 0; i < counts_.events.size(); ++i) counts_.events[i] += events[i];
}

void Wavefront::bind() {
  const PlyTree& tree = scene_->fabric().tree;
  if (!tree.leaf_offset.empty() && tree.form.quantised() != features_.quantised_vertices)
    bug("wavefront: kernels and leaves differ in how vertices are kept");
  // `first` is the index behind WFrame, which every launch sets anew.
  const auto path = [&](cl::Kernel& k, cl_uint first) { return bind_path(k, first); };
  auto& generate = kernel("generate");
  generate.setArg(1, camera_);
  set_args(generate, path(generate, 2), spare_list_.cl(), queue_counts_.cl());
  for (const char* name : {"intersect", "intersect_packets"})
    if (kernels_.contains(name)) bind_intersect(name);
  auto& miss = kernel("miss");
  cl_uint next = scene_->bind_lights(miss, path(miss, 1));
  set_args(miss, next, aov_.cl(), miss_list_.cl(), queue_counts_.cl(), kHits + 2);
  if (kernels_.contains("shade_ply")) {
    auto& k = kernel("shade_ply");
    next = scene_->bind_lights(k, scene_->bind_scene(k, path(k, 1), features_.procedural));
    set_args(k, next, scene_->frames(), uint32_t(features_.normals), scene_->ply_materials());
    next += 3;
    if (features_.detail) {
      set_args(k, next, scene_->fibre_details(), scene_->fibre_offsets(), scene_->fibre_candidates());
      set_args(k, next + 3, pixel_width(camera_));
      next += 4;
    }
    if (features_.ply_colors) next = scene_->bind_ply_colors(k, next);
    set_args(k, next, aov_.cl(), ply_list_.cl(), queue_counts_.cl(), kHits);
  }
  if (kernels_.contains("shade_fibre")) {
    auto& k = kernel("shade_fibre");
    next = scene_->bind_lights(k, scene_->bind_scene(k, path(k, 1), features_.procedural));
    set_args(k, next, scene_->frames(), uint32_t(features_.normals), scene_->fibre_materials());
    next += 3;
    if (features_.ply_colors) next = scene_->bind_ply_colors(k, next);
    set_args(k, next, aov_.cl(), fibre_list_.cl(), queue_counts_.cl(), kHits + 3);
  }
  if (kernels_.contains("shade_surface")) {
    auto& k = kernel("shade_surface");
    next = scene_->bind_lights(k, path(k, 1));
    set_args(k, next, scene_->triangles(), scene_->spheres(), scene_->surface_materials(), aov_.cl(),
             surface_list_.cl(), queue_counts_.cl(), kHits + 1);
  }
  if (features_.lights) {
    auto& k = kernel("connect");
    next = scene_->bind_scene(k, path(k, 1), features_.procedural);
    set_args(k, next, shadow_list_.cl(), queue_counts_.cl());
  }
  set_args(kernel("accumulate"), 1, camera_, tiles_.cl());
  if (features_.four_vectors()) {
    set_args(kernel("accumulate_aov"), 1, camera_, tiles_.cl());
    kernel("accumulate_aov").setArg(8, shift_);
  }
}

void Wavefront::shift_positions(const dvec3& shift) {
  shift_ = {{float(shift.x), float(shift.y), float(shift.z), 0}};
  if (features_.four_vectors()) kernel("accumulate_aov").setArg(8, shift_);
}

void Wavefront::launch(const std::string& name, size_t items, bool camera_rays) {
  cl::Event event;
  const std::clock_t start = std::clock();
  device_.queue().enqueueNDRangeKernel(kernel(name), cl::NullRange, device_.global(items), device_.local(), nullptr,
                                       &event);
  if (count_cpu_time_) device_.queue().finish();
  pending_.push_back({name, event, camera_rays, double(std::clock() - start) / CLOCKS_PER_SEC});
}

void Wavefront::launch_intersect(const Buffer<uint32_t>& list, uint32_t count_index, uint32_t depth, size_t bound) {
  auto& k = kernel(nearest(depth));
  set_args(k, k.getInfo<CL_KERNEL_NUM_ARGS>() - 4, list.cl(), queue_counts_.cl(), count_index, depth);
  launch(nearest(depth), in_packets(depth) ? bound / size_t(features_.lanes) + 1 : bound, depth == 0);
}

void Wavefront::launch_connect(uint32_t count_index, uint32_t depth, size_t bound) {
  auto& k = kernel("connect");
  set_args(k, k.getInfo<CL_KERNEL_NUM_ARGS>() - 2, count_index, depth);
  launch("connect", bound);
}

void Wavefront::set_frame(const WFrame& frame) {
  for (const char* name : {"generate", "intersect", "intersect_packets", "miss", "shade_ply", "shade_fibre",
                           "shade_surface", "connect", "accumulate", "accumulate_aov"})
    if (const auto found = kernels_.find(name); found != kernels_.end()) found->second.setArg(0, frame);
}

void Wavefront::compact(const Buffer<uint32_t>& list, uint32_t count_index, uint32_t total_index, size_t bound,
                        const Buffer<uint32_t>& out0, const Buffer<uint32_t>& out1, const Buffer<uint32_t>& out2) {
  const size_t chunks = bound / kChunk + 1;
  set_args(kernel("compact_count"), 0, list.cl(), mask_.cl(), queue_counts_.cl(), count_index, chunk_.cl());
  launch("compact_count", chunks);
  set_args(kernel("compact_scan"), 0, queue_counts_.cl(), count_index, total_index, chunk_.cl());
  launch("compact_scan", 1);
  set_args(kernel("compact_scatter"), 0, list.cl(), mask_.cl(), queue_counts_.cl(), count_index, chunk_.cl(), out0.cl(),
           out1.cl(), out2.cl());
  if (features_.fibres) kernel("compact_scatter").setArg(8, fibre_list_.cl());
  launch("compact_scatter", chunks);
}

void Wavefront::trace(WFrame frame, const std::vector<uint32_t>& tiles, uint32_t first_sample, uint32_t samples) {
  const uint32_t pixels = uint32_t(tiles.size()) * kTilePixels;
  frame.samples_before = first_sample;
  frame.samples_in_wave = samples;
  frame.paths = pixels * samples;
  take_packets();
  set_frame(frame);
  tiles_.write(device_, tiles);
  const bool recording = record_ && waves_ % record_->every == 0;
  ++waves_;

  launch("generate", frame.paths);
  size_t bound = frame.paths;  // launches cover at least the live paths; lengths only ever shrink
  compact(spare_list_, kGenerated, kShaded[1], bound, active_[0], shadow_list_, miss_list_);
  uint32_t count_index = kShaded[1], side = 0;
  std::array<std::array<uint32_t, kQueueCounts>, 2> lengths{};
  cl::Event read[2];
  for (uint32_t depth = 0;; ++depth) {
    if (depth == kDepthCap) {
      counts_.events[W_EVENT_PATH_CAP] += uint32_t(bound);
      break;
    }
    const auto& live = active_[side];
    launch_intersect(live, count_index, depth, bound);
    if (recording) keep_rays(frame, depth ? RayKind::bounce : RayKind::primary, live, count_index, depth);
    compact(live, count_index, kHits, bound, ply_list_, surface_list_, miss_list_);
    launch("miss", bound);
    for (const char* name : {"shade_ply", "shade_fibre", "shade_surface"})
      if (const auto found = kernels_.find(name); found != kernels_.end()) {
        found->second.setArg(found->second.getInfo<CL_KERNEL_NUM_ARGS>() - 1, depth);
        launch(name, bound);
      }
    const uint32_t shaded = kShaded[side];
    compact(live, count_index, shaded, bound, active_[1 - side], shadow_list_, spare_list_);
    if (features_.lights && scene_->samples_lights()) {
      if (recording) keep_rays(frame, RayKind::shadow, shadow_list_, shaded + 1, depth);
      launch_connect(shaded + 1, depth, bound);
    }
    device_.queue().enqueueReadBuffer(queue_counts_.cl(), CL_FALSE, 0, sizeof(lengths[0]), lengths[depth % 2].data(),
                                      nullptr, &read[depth % 2]);
    device_.queue().flush();
    count_index = shaded;
    // The lengths of the bounce before this one bound the next launch; this one's are still on their way.
    if (depth > 0) {
      read[(depth - 1) % 2].wait();
      const auto& before = lengths[(depth - 1) % 2];
      const uint32_t was = kShaded[1 - side];
      // Pixels are padded to whole tiles: only those of the picture have paths.
      const uint32_t were_live = depth == 1 ? before[kShaded[1]] : uint32_t(bound);
      if (depth == 1) {
        counts_.primary += were_live;
        counts_.paths += were_live;
      }
      bound = before[was];
      counts_.bounce += before[was];
      counts_.shadow += before[was + 1];
      counts_.add_bounce(nearest(depth - 1), were_live, before.data() + kHits, before[was + 1]);
      counts_.deepest = std::max(counts_.deepest, depth);
      if (bound == 0) {
        read[depth % 2].wait();
        break;
      }
    }
    side = 1 - side;
  }
  for (const size_t band : film_.bands_of(tiles)) {
    const auto [band_first, band_pixels] = film_.pixels_of(band);
    set_args(kernel("accumulate"), 3, band_first, band_pixels, radiance_.cl(), film_.radiance(band), scene_->events());
    launch("accumulate", pixels);
    if (!features_.four_vectors()) continue;
    set_args(kernel("accumulate_aov"), 3, band_first, band_pixels, aov_.cl(), film_.aov(band), film_.ply(band));
    launch("accumulate_aov", pixels);
  }
  device_.queue().finish();
  counts_.add_wave(frame.paths);
  harvest_events();
}

void Wavefront::harvest_events() {
  for (const Launch& launch : pending_)
    counts_.add_launch(
        launch.kernel,
        count_cpu_time_ ? launch.cpu_seconds / device_.traits().compute_units : device_seconds(launch.event),
        launch.camera_rays);
  pending_.clear();
}

WaveCounts Wavefront::counts() const {
  WaveCounts counts = counts_;
  std::erase_if(counts.stages, [](const auto& stage) { return stage.second.launches == 0; });
  const auto events = scene_->read_events();
  for (size_t i = 0; i < counts.events.size(); ++i) counts.events[i] += events[i];
  return counts;
}

}  // namespace wale
