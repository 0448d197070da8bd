#include "host/wavefront.h"

#include <algorithm>
#include <chrono>
#include <ctime>

#include "geom/error.h"
#include "host/kernel_args.h"

namespace wale {
namespace {

constexpr uint32_t kChunk = 256;       // W_CHUNK of compact.cl
constexpr uint32_t kDepthCap = 65536;  // no path is this long; reaching it is counted as an event

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

void Wavefront::launch(const std::string& name, size_t count, bool camera_rays) {
  cl::Event event;
  const std::clock_t start = std::clock();
  const size_t at_once = taken_at_once_.at(name);
  device_.queue().enqueueNDRangeKernel(kernel(name), cl::NullRange, device_.global((count + at_once - 1) / at_once),
                                       device_.local(at_once), nullptr, &event);
  if (count_cpu_time_) device_.queue().finish();
  pending_.push_back({name, event, camera_rays, double(std::clock() - start) / CLOCKS_PER_SEC});
}

void Wavefront::launch_intersect(const Buffer<uint32_t>& list, uint32_t count_index, uint32_t depth, size_t bound) {
  auto& k = kernel(nearest(depth));
  set_args(k, k.getInfo<CL_KERNEL_NUM_ARGS>() - 4, list.cl(), queue_counts_.cl(), count_index, depth);
  launch(nearest(depth), bound, depth == 0);
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
