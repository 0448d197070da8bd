#pragma once
#include <memory>
#include <span>
#include <vector>

#include "host/device.h"
#include "host/render.h"
#include "host/scene_device.h"
#include "host/world.h"

namespace wale {

/// What a new version of a scene made necessary.
struct Redone {
  size_t knitted = 0;         ///< fabrics that were knitted
  bool fabrics = false;       ///< fabrics went to the devices: warp, leaves, tree
  bool moved = false;         ///< fabrics on the devices followed their meshes: warp and refit
  double host_seconds = 0;    ///< knitting, and tables of materials, lights and colours
  double device_seconds = 0;  ///< wall time of all devices together
};

/// A scene on devices that is edited or animated: each version redoes only what differs from the one before. Devices
/// that are the same get the same data.
class LiveScene {
 public:
  struct Options {
    RenderOptions render;  ///< programs and paths that memory is checked for
    bool editable = true;  ///< keep what another version's colours need
  };

  /// Devices and loaders must outlive it.
  LiveScene(std::span<const Device> devices, const Loaders& loaders, const Options& options);

  /// Makes `scene` what is on the devices. Throws the user and device errors of build_world(), require_memory() and
  /// upload_fabrics(); the version before then stays.
  Redone apply(const Scene& scene, const BuildProgress& progress = {});

  /// Versions from now on are refused where a fabric would have to be knitted and have more segments.
  void limit_segments(double most) { most_segments_ = most; }

  const Scene& scene() const { return scene_; }
  const World& world() const { return world_; }
  /// Valid until the next apply().
  std::span<const RenderDevice> devices() const { return list_; }

 private:
  std::span<const Device> devices_;
  const Loaders& loaders_;
  Options options_;
  double most_segments_ = 0;
  Scene scene_;
  World world_;
  std::vector<std::unique_ptr<SceneDevice>> on_device_;
  std::vector<RenderDevice> list_;
};

}  // namespace wale
