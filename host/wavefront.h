#pragma once
#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host/device.h"
#include "host/features.h"
#include "host/film_device.h"
#include "host/ray_batch.h"
#include "host/scene_device.h"
#include "host/stages.h"
#include "host/wave_counts.h"

namespace wale {

/// Film and path state on the device, and the kernels of one set of features. One wave traces any tiles of 8 x 8 pixels
/// times a run of samples to the end of every path: generate, then per bounce intersect, compact, miss, shade, compact,
/// connect, then accumulate. Queue lengths stay on the device; the host reads them one bounce late to size its
/// launches.
class Wavefront {
 public:
  Wavefront(const Device& device, const SceneDevice& scene, const Features& features, const WCamera& camera,
            uint32_t pool, const std::filesystem::path& kernel_dir = {});

  uint32_t pool() const { return pool_; }

  /// Goes on with another version of the scene, seen by another camera with as many pixels, and an empty film unless
  /// it is kept. The programs stay: the version must be one that they serve (serves()).
  void rebind(const SceneDevice& scene, const Features& features, const WCamera& camera, bool keep_film = false);
  /// From now on the positions of what is met count from a place that lies at -shift, metres, from the scene's origin:
  /// a film that is kept has one place, whatever the origins of the versions it is made of.
  void shift_positions(const dvec3& shift);
  /// Counts the rare events of its scene so far, which may go afterwards: before it is bound to another one.
  void leave_scene();
  /// Programs built for `features` and a scene that lies like `scene` are those of this wavefront.
  bool serves(const SceneDevice& scene, const Features& features) const;

  /// Traces `samples` samples from `first_sample` of the pixels of these tiles and adds them to the film; pixels of the
  /// border tiles that lie outside the picture are skipped. At most the pool's paths, but one tile at least.
  void trace(WFrame frame, const std::vector<uint32_t>& tiles, uint32_t first_sample, uint32_t samples);

  /// Waits for every launch and counts the CPU seconds of all threads over the compute units as its time, which other
  /// programs on the machine disturb less than the clock; for CPU devices.
  void count_cpu_time(bool yes) { count_cpu_time_ = yes; }

  /// While set, trace() reads back the rays that it sends: its own times then say little. Null ends it.
  void record(RayRecord* record) { record_ = record; }
  /// Puts recorded rays into the path state; the pool must be as large as that of the wavefront they come from.
  void load(const RayBatch& batch);
  /// Sends the loaded rays through the same launch as trace(), once. Returns seconds by the device's clock.
  double trace_loaded(const RayBatch& batch);
  /// What trace_loaded() found, per ray: t, kind, code as in RayBatch::found; of shadow rays x = 1 where light arrives.
  std::vector<w_float4> read_found(const RayBatch& batch) const;

  FilmDevice& film() { return film_; }
  WaveCounts counts() const;
  uint64_t bytes() const { return bytes_ + film_.bytes(); }

 private:
  // Places of the queue lengths in queue_counts_.
  static constexpr uint32_t kGenerated = 0, kHits = 1, kShaded[2] = {5, 9}, kQueueCounts = 13;

  void build_programs();
  /// Sets the arguments that follow from the scene and the camera.
  void bind();
  /// Sets the arguments of W_PATH_PARAMS from `first` on; returns the next free index.
  cl_uint bind_path(cl::Kernel& kernel, cl_uint first) const;
  void bind_intersect(const char* name);
  /// Packets are used from the first wave on that finds them compiled; they find the same hits.
  void take_packets();
  std::string options_;  ///< that the programs were built with
  cl::Kernel& kernel(const std::string& name) { return kernels_.at(name); }
  void launch(const std::string& name, size_t count, bool camera_rays = false);
  bool in_packets(uint32_t depth) const { return depth == 0 && kernels_.contains("intersect_packets"); }
  /// Kernel that finds the nearest hits at this depth.
  const char* nearest(uint32_t depth) const { return in_packets(depth) ? "intersect_packets" : "intersect"; }
  void launch_intersect(const Buffer<uint32_t>& list, uint32_t count_index, uint32_t depth, size_t bound);
  void launch_connect(uint32_t count_index, uint32_t depth, size_t bound);
  void set_frame(const WFrame& frame);
  void keep_rays(const WFrame& frame, RayKind kind, const Buffer<uint32_t>& list, uint32_t count_index, uint32_t depth);
  void compact(const Buffer<uint32_t>& list, uint32_t count_index, uint32_t total_index, size_t bound,
               const Buffer<uint32_t>& out0, const Buffer<uint32_t>& out1, const Buffer<uint32_t>& out2);
  uint32_t bins() const { return features_.fibres ? 4 : 3; }  // W_BINS of compact.cl
  void harvest_events();

  const Device& device_;
  const SceneDevice* scene_;
  Features features_;
  WCamera camera_;
  cl_float4 shift_{};  ///< see shift_positions()
  std::filesystem::path kernel_dir_;
  std::optional<StageProgram> waiting_;  ///< that of packets, while it is being compiled
  uint32_t pool_;
  uint64_t bytes_ = 0;
  std::map<std::string, cl::Kernel> kernels_;
  std::map<std::string, size_t> taken_at_once_;  ///< by kernel, as Stage
  struct Launch {
    std::string kernel;
    cl::Event event;
    bool camera_rays;
    double cpu_seconds;
  };
  std::vector<Launch> pending_;
  WaveCounts counts_;
  RayRecord* record_ = nullptr;
  bool count_cpu_time_ = false;
  uint32_t waves_ = 0;

  Buffer<w_float4> ray_o_, ray_l_, ray_d_, weight_, hit_, radiance_, shadow_o_, shadow_l_, shadow_d_, shadow_c_;
  Buffer<std::array<float, 2>> hit_uv_;
  Buffer<uint32_t> mask_, active_[2], ply_list_, surface_list_, miss_list_, fibre_list_, shadow_list_, spare_list_,
      chunk_, queue_counts_, tiles_;
  Buffer<w_float4> aov_;  ///< or the gradients
  Buffer<w_float4> score_, shadow_gradient_;
  FilmDevice film_;
};

}  // namespace wale
