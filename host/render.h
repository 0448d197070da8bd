#pragma once
#include <filesystem>
#include <functional>
#include <span>

#include "host/film.h"
#include "host/tile_error.h"
#include "host/wavefront.h"

namespace wale {

struct RenderDevice;

/// The scene at one of the moments that a picture is made of.
struct Moment {
  const World* world = nullptr;
  std::span<const RenderDevice> devices;
};

struct RenderOptions {
  int spp = 64;        ///< samples per pixel; with a goal the most
  double error = 0;    ///< > 0: goal; a tile stops when its relative error is this small (host/error_goal.h)
  double seconds = 0;  ///< > 0: stop after this time, but not before every pixel has a sample
  uint32_t pool = 0;   ///< paths in flight; 0 = from the device
  bool aovs = false;
  bool gradients = false;  ///< derivatives by the plies' material in the place of feature images; of plies alone
  Features also;  ///< built in beside what the scene calls for
  bool count_cpu_time = false;  ///< stages by CPU time: see Wavefront::count_cpu_time
  RayRecord* record = nullptr;  ///< keeps the rays that are sent
  std::filesystem::path kernel_dir;
  uint32_t moments = 1;     ///< > 1: motion blur; samples are shared out to them in runs, one after the other
  /// Makes the scene that of moment k > 0 on the same devices; programs must serve it. Not with a goal.
  std::function<Moment(uint32_t)> at_moment;
  std::function<void()> ready;  ///< called when all programs are built, before the first ray
};

/// Paths in flight on a device: what the options say, else the scene, else the device's table of traits.
uint32_t pool_of(const DeviceTraits& traits, const IntegratorScene& integrator, const RenderOptions& options);

/// What the integrator tells the kernels; samples and paths are those of each wave.
WFrame frame_of(const World& world, const IntegratorScene& integrator);

/// What its programs are built for.
Features features_of(const DeviceTraits& traits, const World& world, const IntegratorScene& integrator,
                     const RenderOptions& options);

/// A device and the scene on it.
struct RenderDevice {
  const Device* device = nullptr;
  const SceneDevice* scene = nullptr;
};

/// What one device did of a render.
struct DeviceShare {
  WaveCounts counts;
  double busy_seconds = 0;       ///< from taking a unit of work to its end, all units
  uint32_t units = 0, pool = 0;  ///< units of work; paths in flight
  uint64_t path_bytes = 0;       ///< path state and film
  uint64_t moved_blocks = 0;     ///< blocks of pixels whose sums it took over from another device
};

struct Rendered {
  Image image;
  WaveCounts counts;  ///< of all devices
  std::vector<DeviceShare> devices;
  double seconds = 0;               ///< from the first wave on
  double cpu_seconds = 0;           ///< the same time, of all threads of this process
  double first_sample_seconds = 0;  ///< of them, until the first device's first wave was done
  double program_seconds = 0;       ///< wall time until all programs were built
  Reached reached;                  ///< noise and samples of the picture's tiles
  bool stopped = false;             ///< by Ctrl-C or the time limit
};

/// Renders a world on devices that share its samples, each at its own pace. The picture depends on the scene, spp, the
/// error goal and the seed alone: not on pool, threads or the number of (like) devices. Ctrl-C and the time limit stop
/// between waves and keep what is there; the last waves before the time limit are made as short as what is left of it. When one device fails, all stop and its error is thrown, naming it.
Rendered render(std::span<const RenderDevice> devices, const World& world, const IntegratorScene& integrator,
                const RenderOptions& options, const std::function<void(double fraction)>& progress = {});

/// The same on one device.
Rendered render(const Device& device, const World& world, const SceneDevice& scene, const IntegratorScene& integrator,
                const RenderOptions& options, const std::function<void(double fraction)>& progress = {});

}  // namespace wale
