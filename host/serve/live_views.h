#pragma once
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "host/live_scene.h"
#include "host/serve/progressive_render.h"

namespace wale {

/// How far all pictures of a version are.
struct ViewsProgress {
  uint32_t samples = 0;                 ///< of the one that has the fewest
  double error = 0;                     ///< of the one that has the largest; 0 = not known yet
  double mrays = 0;                     ///< 1e6 rays a second, mean
  double seconds = 0;                   ///< of tracing, sum
  std::optional<double> to_goal;        ///< seconds that are left, where it is known
  uint64_t not_finite = 0;              ///< samples of this version that were not finite: left out of its pictures
  uint64_t not_finite_since_start = 0;  ///< of this version and those before
};

/// One or more views of an edited scene, each a version of it that is on the device in its turn, rendered
/// progressively: the one that is farthest behind first.
class LiveViews {
 public:
  /// Devices and loaders must outlive it; it renders on the first device.
  LiveViews(std::span<const Device> devices, const Loaders& loaders, const std::filesystem::path& kernel_dir);

  /// Begins anew with these versions of a scene, one a view. Throws what LiveScene::apply() does; show() must then be
  /// called again, with versions that can be made.
  Redone show(const std::vector<Scene>& scenes);

  /// Versions from now on are refused where a fabric would have more segments.
  void limit_segments(double most) { live_.limit_segments(most); }

  size_t count() const { return renders_.size(); }
  /// Each has a picture of this version, be it of few pixels.
  bool all_seen() const;
  ProgressiveRender& render(size_t view) { return *renders_[view]; }
  const World& world() const { return live_.world(); }
  size_t segments() const;

  /// The view to go on with; nothing when all have reached the goal, or the most samples.
  std::optional<size_t> next(double goal) const;
  /// Traces one wave of a view. True when its picture is worth showing again. Throws what LiveScene::apply() does, as
  /// the views take turns on the device; show() must then be called again.
  bool step(size_t view);
  ViewsProgress progress(double goal) const;

 private:
  Redone apply(const Scene& scene);
  uint64_t not_finite_on_device() const;

  const Device& device_;
  std::filesystem::path kernel_dir_;
  LiveScene live_;
  std::vector<Scene> scenes_;
  std::vector<std::unique_ptr<ProgressiveRender>> renders_;
  size_t on_device_ = 0;                                   ///< view
  uint64_t not_finite_gone_ = 0, not_finite_earlier_ = 0;  ///< counted by scenes that left; before this version
};

}  // namespace wale
