#pragma once
#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "host/cost/bias.h"
#include "host/cost/levels.h"
#include "host/render.h"
#include "host/world.h"

namespace wale::cost {

/// Seconds before the first ray, and what then lies on the device.
struct StartPrice {
  double knit = 0, warp = 0, tree = 0, programs = 0;
  uint64_t bytes = 0;
  double geometry() const { return knit + warp + tree; }
  double all() const { return geometry() + programs; }
};

/// Geometry of a unit, ready to be rendered.
struct Prepared {
  World world;
  std::unique_ptr<SceneDevice> on_device;
  StartPrice start;  ///< without programs
};

/// One render as for an .exr: its picture, its noise and what it took. Times are of the rays alone.
struct Repetition {
  Picture picture;
  std::vector<float> variance;  ///< of each value of the picture
  double wall = 0, cpu = 0;     ///< seconds; cpu: of all threads of this process
  double program_seconds = 0;
  uint64_t nan_samples = 0;
  bool complete = false;  ///< false when the user stopped it
};

/// Where camera rays met the plies.
using Hits = std::vector<dvec3>;

/// Renders units, and keeps the geometry of those that came first, as far as `most_bytes` go. Of others it holds one at
/// a time.
class MeasuredScenes {
 public:
  MeasuredScenes(const Device& device, const Loaders& loaders, uint64_t most_bytes, std::filesystem::path kernel_dir);

  /// Knits and uploads, unless it is there. Throws user errors where a scene cannot be built or has no room.
  std::shared_ptr<const Prepared> prepare(const Unit& unit);
  /// The unit's geometry is there to stay; else each visit builds it, unless the visit before was of the same.
  bool keeps(const Unit& unit) const { return kept_.contains(unit.geometry); }
  void forget(const Unit& unit);

  Repetition render_once(const Unit& unit, int samples, unsigned seed);
  /// First hits of one jittered ray a pixel with a ply, metres in the scene.
  Hits first_hits(const Unit& unit, unsigned seed);

 private:
  Rendered run(const Unit& unit, int samples, unsigned seed);

  const Device& device_;
  const Loaders& loaders_;
  uint64_t most_bytes_, bytes_ = 0;
  std::filesystem::path kernel_dir_;
  std::map<std::string, std::shared_ptr<const Prepared>> kept_;
  std::string passing_name_;  ///< of what is not kept
  std::shared_ptr<const Prepared> passing_;
};

/// Bytes that geometry may fill on a device: half of it; where the device is the host, a quarter of what is free.
uint64_t memory_to_use(const DeviceTraits& traits);

}  // namespace wale::cost
