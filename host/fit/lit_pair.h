#pragma once
#include <array>
#include <filesystem>
#include <vector>

#include "host/fit/picture.h"
#include "host/live_scene.h"

namespace wale::fit {

/// Sides that a cloth is photographed under, in the order in which pairs are kept.
constexpr std::array<const char*, 2> kLitSides = {"front", "back"};

/// The scene under the lights of one side: those whose names begin with "front" or "back"; lights of other names shine
/// in both pictures. Throws a user error where a side has no light.
Scene lit_from(const Scene& scene, size_t side);

/// Thrown when Ctrl-C has ended a render: its picture is not whole.
struct Stopped {};

/// Renders the two pictures of a scene, again and again as its materials change.
class LitPair {
 public:
  /// `sides`: which of the two are wanted; the others stay empty. The device and the loaders must outlive it.
  LitPair(const Device& device, const Loaders& loaders, const std::filesystem::path& kernel_dir,
          std::array<bool, 2> sides = {true, true});

  /// The pictures, each of `samples` paths a pixel, film.exposure applied. Paths of one seed are the same from scene to
  /// scene as far as materials let them. Throws Stopped.
  PicturePair render(const Scene& scene, int samples, uint32_t seed);

  /// The same and, from the same paths, their derivatives by what kernels/appearance/ply_gradient.clh says.
  struct WithGradients {
    PicturePair pictures;
    std::array<PicturePair, W_GRADIENT_COUNT> by;
  };
  WithGradients render_with_gradients(const Scene& scene, int samples, uint32_t seed);

 private:
  Image render_side(const Scene& scene, size_t side, bool gradients, int samples, uint32_t seed);

  RenderOptions options_;
  LiveScene live_;
  std::array<bool, 2> sides_;
};

}  // namespace wale::fit
