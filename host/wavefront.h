#pragma once
#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "host/device.h"
#include "host/features.h"
#include "host/film_device.h"
#include "host/scene_device.h"

namespace wale {

/// Seconds and launches of one stage, from the device's own clock.
struct StageTime {
  double seconds = 0;
  size_t launches = 0;
};

/// What the wavefront counted. Of several devices: sums, seconds too; the longest path of all.
struct WaveCounts {
  uint64_t primary = 0, bounce = 0, shadow = 0, paths = 0;
  uint32_t deepest = 0;
  std::array<uint32_t, W_EVENT_COUNT> events{};
  std::map<std::string, StageTime> stages;
  std::map<std::string, double> program_seconds;

  WaveCounts& operator+=(const WaveCounts& other);
};

/// Film and path state on the device, and the kernels of one set of features. One wave traces a block of pixels times a
/// run of samples to the end of every path: generate, then per bounce intersect, compact, miss, shade, compact,
/// connect, then accumulate. Queue lengths stay on the device; the host reads them one bounce late to size its
/// launches.
class Wavefront {
 public:
  Wavefront(const Device& device, const SceneDevice& scene, const Features& features, const WCamera& camera,
            uint32_t pool, const std::filesystem::path& kernel_dir = {});

  uint32_t pool() const { return pool_; }

  /// Traces `samples` samples from `first_sample` of pixels [first_pixel, first_pixel + pixels) and adds them to the
  /// film; pixel numbers run along 8 x 8 tiles (padded_pixels), those outside the picture are skipped.
  void trace(WFrame frame, uint32_t first_pixel, uint32_t pixels, uint32_t first_sample, uint32_t samples);

  FilmDevice& film() { return film_; }
  WaveCounts counts() const;
  uint64_t bytes() const { return bytes_ + film_.bytes(); }

 private:
  void build_programs(const std::filesystem::path& kernel_dir);
  cl::Kernel& kernel(const std::string& name) { return kernels_.at(name); }
  void launch(const std::string& name, size_t items);
  void compact(const Buffer<uint32_t>& list, uint32_t count_index, uint32_t total_index, size_t bound,
               const Buffer<uint32_t>& out0, const Buffer<uint32_t>& out1, const Buffer<uint32_t>& out2);
  uint32_t bins() const { return features_.fibres ? 4 : 3; }  // W_BINS of compact.cl
  void harvest_events();

  const Device& device_;
  const SceneDevice& scene_;
  Features features_;
  WCamera camera_;
  uint32_t pool_;
  uint64_t bytes_ = 0;
  std::map<std::string, cl::Kernel> kernels_;
  std::vector<std::pair<std::string, cl::Event>> pending_;
  WaveCounts counts_;

  Buffer<w_float4> ray_o_, ray_l_, ray_d_, weight_, hit_, radiance_, shadow_o_, shadow_l_, shadow_d_, shadow_c_;
  Buffer<std::array<float, 2>> hit_uv_;
  Buffer<uint32_t> mask_, active_[2], ply_list_, surface_list_, miss_list_, fibre_list_, shadow_list_, spare_list_,
      chunk_, queue_counts_;
  Buffer<w_float4> aov_;
  FilmDevice film_;
};

}  // namespace wale
