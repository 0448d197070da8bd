#include "host/wavefront.h"

#include <algorithm>
#include <chrono>
#include <future>

#include "geom/error.h"
#include "host/program.h"
#include "host/stages.h"

namespace wale {
namespace {

constexpr uint32_t kChunk = 256;       // W_CHUNK of compact.cl
constexpr uint32_t kTile = 8;          // W_TILE of path_state.clh
constexpr uint32_t kDepthCap = 65536;  // no path is this long; reaching it is counted as an event

// Places of the queue lengths in queue_counts_.
constexpr uint32_t kGenerated = 0, kHits = 1, kShaded[2] = {5, 9}, kQueueCounts = 13;

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
    : device_(device), scene_(scene), features_(features), camera_(camera), pool_(std::max(64u, pool)) {
  const auto vec = [&](Buffer<w_float4>& buffer, size_t count) {
    buffer = Buffer<w_float4>(device_, count);
    bytes_ += buffer.bytes();
  };
  const auto ints = [&](Buffer<uint32_t>& buffer, size_t count) {
    buffer = Buffer<uint32_t>(device_, count);
    bytes_ += buffer.bytes();
  };
  const size_t pixels = size_t(camera.width) * camera.height;
  const uint64_t film_bytes = pixels * kScrambles * sizeof(w_float4);
  if (film_bytes > device.traits().max_alloc_bytes)
    user_error("film.size: {} x {} pixels need {} bytes in one buffer, the device allows {}", camera.width,
               camera.height, film_bytes, device.traits().max_alloc_bytes);
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
  vec(film_, pixels * kScrambles);
  film_.fill(device_, w_float4{0, 0, 0, 0});
  vec(aov_, features_.aovs ? size_t(pool_) * 4 : 0);
  vec(aov_film_, features_.aovs ? pixels * 4 : 0);
  ints(ply_film_, features_.aovs ? pixels : 0);
  aov_film_.fill(device_, w_float4{0, 0, 0, 0});
  ply_film_.fill(device_, W_NONE);
  build_programs(kernel_dir);
}

void Wavefront::build_programs(const std::filesystem::path& kernel_dir) {
  std::vector<Stage> stages = wavefront_stages(features_);
  std::erase_if(stages, [](const Stage& stage) { return !stage.used; });

  // One thread per stage, where the driver bears it: compilation is the whole of the start-up time.
  const auto policy = device_.traits().parallel_builds ? std::launch::async : std::launch::deferred;
  using Clock = std::chrono::steady_clock;
  std::vector<std::future<std::pair<cl::Program, double>>> builds;
  for (const auto& stage : stages)
    builds.push_back(std::async(policy, [&, file = stage.file] {
      const auto start = Clock::now();
      cl::Program program = build_program(device_, file, features_.options(), kernel_dir);
      return std::pair(program, std::chrono::duration<double>(Clock::now() - start).count());
    }));
  for (size_t i = 0; i < stages.size(); ++i) {
    auto [program, seconds] = builds[i].get();
    counts_.program_seconds[stages[i].file] = seconds;
    for (const auto& name : stages[i].kernels) kernels_[name] = cl::Kernel(program, name.c_str());
  }

  // Arguments that never change are set once; `first` is the index behind WFrame.
  const auto path = [&](cl::Kernel& k, cl_uint first) {
    set_args(k, first, ray_o_.cl(), ray_l_.cl(), ray_d_.cl(), weight_.cl(), hit_.cl(), hit_uv_.cl(), radiance_.cl(),
             shadow_o_.cl(), shadow_l_.cl(), shadow_d_.cl(), shadow_c_.cl(), mask_.cl());
    return first + 12;
  };
  auto& generate = kernel("generate");
  generate.setArg(1, camera_);
  set_args(generate, path(generate, 2), spare_list_.cl(), queue_counts_.cl());
  for (const char* name : {"intersect", "intersect_packets"})
    if (kernels_.contains(name)) scene_.bind_scene(kernel(name), path(kernel(name), 1));
  auto& miss = kernel("miss");
  cl_uint next = scene_.bind_lights(miss, path(miss, 1));
  set_args(miss, next, aov_.cl(), miss_list_.cl(), queue_counts_.cl(), kHits + 2);
  if (kernels_.contains("shade_ply")) {
    auto& k = kernel("shade_ply");
    next = scene_.bind_lights(k, scene_.bind_scene(k, path(k, 1)));
    set_args(k, next, scene_.vertices(), scene_.ply_materials());
    next += 2;
    if (features_.detail) {
      set_args(k, next, scene_.fibre_details(), scene_.fibre_offsets(), scene_.fibre_candidates());
      set_args(k, next + 3, pixel_width(camera_));
      next += 4;
    }
    if (features_.ply_colors) set_args(k, next++, scene_.ply_colors());
    set_args(k, next, aov_.cl(), ply_list_.cl(), queue_counts_.cl(), kHits);
  }
  if (kernels_.contains("shade_fibre")) {
    auto& k = kernel("shade_fibre");
    next = scene_.bind_lights(k, scene_.bind_scene(k, path(k, 1)));
    set_args(k, next, scene_.vertices(), scene_.fibre_materials());
    next += 2;
    if (features_.ply_colors) set_args(k, next++, scene_.ply_colors());
    set_args(k, next, aov_.cl(), fibre_list_.cl(), queue_counts_.cl(), kHits + 3);
  }
  if (kernels_.contains("shade_surface")) {
    auto& k = kernel("shade_surface");
    next = scene_.bind_lights(k, path(k, 1));
    set_args(k, next, scene_.triangles(), scene_.spheres(), scene_.surface_materials(), aov_.cl(), surface_list_.cl(),
             queue_counts_.cl(), kHits + 1);
  }
  if (features_.lights) {
    auto& k = kernel("connect");
    next = scene_.bind_scene(k, path(k, 1));
    set_args(k, next, shadow_list_.cl(), queue_counts_.cl());
  }
  auto& accumulate = kernel("accumulate");
  set_args(accumulate, 1, camera_);
  set_args(accumulate, 3, radiance_.cl(), film_.cl(), scene_.events());
  if (features_.aovs) {
    auto& k = kernel("accumulate_aov");
    set_args(k, 1, camera_);
    set_args(k, 3, aov_.cl(), aov_film_.cl(), ply_film_.cl());
  }
}

uint32_t Wavefront::padded_pixels() const {
  const auto tiles = [](int n) { return (uint32_t(n) + kTile - 1) / kTile; };
  return tiles(camera_.width) * tiles(camera_.height) * kTile * kTile;
}

void Wavefront::launch(const std::string& name, size_t items) {
  cl::Event event;
  device_.queue().enqueueNDRangeKernel(kernel(name), cl::NullRange, device_.global(items), device_.local(), nullptr,
                                       &event);
  pending_.emplace_back(name, event);
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

void Wavefront::trace(WFrame frame, uint32_t first_pixel, uint32_t pixels, uint32_t first_sample, uint32_t samples) {
  frame.first_pixel = first_pixel;
  frame.samples_before = first_sample;
  frame.samples_in_wave = samples;
  frame.paths = pixels * samples;
  for (const char* name : {"generate", "intersect", "intersect_packets", "miss", "shade_ply", "shade_fibre", "shade_surface", "connect",
                           "accumulate", "accumulate_aov"})
    if (const auto found = kernels_.find(name); found != kernels_.end()) found->second.setArg(0, frame);

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
    const bool packets = depth == 0 && features_.packets();
    const std::string nearest = packets ? "intersect_packets" : "intersect";
    const uint32_t args = kernel(nearest).getInfo<CL_KERNEL_NUM_ARGS>();
    set_args(kernel(nearest), args - 4, live.cl(), queue_counts_.cl(), count_index, depth);
    launch(nearest, packets ? bound / size_t(features_.lanes) + 1 : bound);
    compact(live, count_index, kHits, bound, ply_list_, surface_list_, miss_list_);
    launch("miss", bound);
    for (const char* name : {"shade_ply", "shade_fibre", "shade_surface"})
      if (const auto found = kernels_.find(name); found != kernels_.end()) {
        found->second.setArg(found->second.getInfo<CL_KERNEL_NUM_ARGS>() - 1, depth);
        launch(name, bound);
      }
    const uint32_t shaded = kShaded[side];
    compact(live, count_index, shaded, bound, active_[1 - side], shadow_list_, spare_list_);
    if (features_.lights) {
      auto& connect = kernel("connect");
      const uint32_t n = connect.getInfo<CL_KERNEL_NUM_ARGS>();
      set_args(connect, n - 2, shaded + 1, depth);
      launch("connect", bound);
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
      if (depth == 1) {  // pixels are padded to whole tiles: only those of the picture have paths
        counts_.primary += before[kShaded[1]];
        counts_.paths += before[kShaded[1]];
      }
      bound = before[was];
      counts_.bounce += before[was];
      counts_.shadow += before[was + 1];
      counts_.deepest = std::max(counts_.deepest, depth);
      if (bound == 0) {
        read[depth % 2].wait();
        break;
      }
    }
    side = 1 - side;
  }
  set_args(kernel("accumulate"), 2, pixels);
  launch("accumulate", pixels);
  if (features_.aovs) {
    set_args(kernel("accumulate_aov"), 2, pixels);
    launch("accumulate_aov", pixels);
  }
  device_.queue().finish();
  harvest_events();
}

void Wavefront::harvest_events() {
  for (const auto& [name, event] : pending_) {
    auto& stage = counts_.stages[name];
    stage.seconds += 1e-9 * double(event.getProfilingInfo<CL_PROFILING_COMMAND_END>() -
                                   event.getProfilingInfo<CL_PROFILING_COMMAND_START>());
    ++stage.launches;
  }
  pending_.clear();
}

std::vector<w_float4> Wavefront::read_aov() const {
  return features_.aovs ? aov_film_.read(device_) : std::vector<w_float4>{};
}

std::vector<uint32_t> Wavefront::read_ply() const {
  return features_.aovs ? ply_film_.read(device_) : std::vector<uint32_t>{};
}

WaveCounts Wavefront::counts() const {
  WaveCounts counts = counts_;
  const auto events = scene_.read_events();
  for (size_t i = 0; i < events.size(); ++i) counts.events[i] += events[i];
  return counts;
}

}  // namespace wale
