#pragma once
#include <array>
#include <filesystem>
#include <memory>
#include <optional>

#include "host/render.h"

namespace wale {

/// How far a picture is.
struct RenderState {
  int shrink = 0;        ///< of the picture that can be shown: 8, 4, 2 or 1 pixels on a side; 0 = none yet
  uint32_t samples = 0;  ///< whole passes over the full picture
  double error = 0;      ///< 95th percentile of its tiles' errors (host/tile_error.h); 0 = not known yet
  double seconds = 0;    ///< of tracing since the restart
  double mrays = 0;      ///< 1e6 rays a second, since the restart
};

/// A picture that can be had soon and gets better: as many of its pixels, down to a 64th, as can be traced at once,
/// then four times as many, until all of them are there and pass follows pass, in waves short enough that an edit need
/// not wait. Kernels, buffers and films stay from version to version of the scene; programs are built with all that
/// edits may bring in, but for the choices that are one or the other (docs/features.md).
class ProgressiveRender {
 public:
  ProgressiveRender(const Device& device, std::filesystem::path kernel_dir);

  /// Begins anew with this version of the scene.
  void restart(const World& world, const IntegratorScene& integrator, const SceneDevice& scene);
  /// Goes on with the same scene after another one has been on the device.
  void resume(const World& world, const IntegratorScene& integrator, const SceneDevice& scene);

  /// Traces one wave. True when the picture is worth showing again.
  bool step();
  /// The picture so far, channels R, G, B, at 1/shrink of the size; brings state().error up to date. Of whole passes
  /// alone, so that it depends on the scene and its samples, not on how fast waves were: not while state().shrink is 1
  /// and a pass has begun. It has not when step() says that the picture is worth showing.
  Image picture();
  const RenderState& state() const { return state_; }
  /// Seconds until the tiles' error is `goal`, as far as the last picture tells; nothing where it does not.
  std::optional<double> seconds_to(double goal) const;

  static RenderOptions options(const std::filesystem::path& kernel_dir);

 private:
  struct Level {
    int shrink;
    std::unique_ptr<Wavefront> wave{};
    uint32_t tiles = 0;
    int width = 0, height = 0;  ///< of its film
    bool empty = true;          ///< the film has nothing of this version
    bool bound = false;         ///< to this version
  };
  size_t first_level() const;
  void bind(const World& world, const IntegratorScene& integrator, const SceneDevice& scene);
  Wavefront& bound(Level& level);

  const Device& device_;
  RenderOptions options_;
  WFrame frame_{};
  Features features_;
  WCamera camera_{};
  const SceneDevice* scene_ = nullptr;
  uint32_t pool_ = 0;
  std::array<Level, 4> levels_;
  size_t level_ = 0;
  uint32_t sample_ = 0, tile_ = 0;  ///< what is traced next on the level
  double seconds_per_path_ = 0;
  uint64_t rays_ = 0;
  double last_picture_ = 0;
  RenderState state_;
};

}  // namespace wale
