#include "host/fit/lit_pair.h"

#include <algorithm>
#include <cmath>

#include "geom/error.h"

namespace wale::fit {
namespace {

RenderOptions options_of(const std::filesystem::path& kernel_dir) {
  RenderOptions options;
  options.kernel_dir = kernel_dir;
  return options;
}

constexpr std::array<Picture PicturePair::*, 2> kSides = {&PicturePair::front, &PicturePair::back};

// The channels prefix.R, .G and .B, at an exposure.
Picture part_of(const Image& image, const std::string& prefix, double exposure, const std::string& name) {
  const auto first = std::find(image.channels.begin(), image.channels.end(), prefix + "R");
  if (first == image.channels.end()) bug("fit: a render without {}R", prefix);
  const auto offset = size_t(first - image.channels.begin());
  const float scale = float(std::exp2(exposure));
  Picture out(image.width, image.height);
  for (size_t i = 0; i < out.count(); ++i)
    for (size_t c = 0; c < 3; ++c) {
      const float value = image.pixels[i * image.channels.size() + offset + c] * scale;
      if (!std::isfinite(value)) bug("{}: pixel {} of {}{} is not finite", name, i, prefix, "RGB"[c]);
      out.pixels[3 * i + c] = value;
    }
  return out;
}

}  // namespace

Scene lit_from(const Scene& scene, size_t side) {
  Scene lit = scene;
  const std::string other = kLitSides[1 - side];
  std::erase_if(lit.lights, [&](const LightScene& light) { return light.name.starts_with(other); });
  const bool any = std::any_of(lit.lights.begin(), lit.lights.end(),
                               [&](const LightScene& light) { return light.name.starts_with(kLitSides[side]); });
  if (!any)
    user_error("{}: lights: none is the {} light of the photographs; give one a name that begins with \"{}\"",
               scene.file, kLitSides[side], kLitSides[side]);
  return lit;
}

LitPair::LitPair(const Device& device, const Loaders& loaders, const std::filesystem::path& kernel_dir,
                 std::array<bool, 2> sides)
    : options_(options_of(kernel_dir)), live_(std::span(&device, 1), loaders, {options_, true}), sides_(sides) {}

Image LitPair::render_side(const Scene& scene, size_t side, bool gradients, int samples, uint32_t seed) {
  Scene lit = lit_from(scene, side);
  lit.integrator.seed = seed;
  live_.apply(lit);
  RenderOptions options = options_;
  options.spp = samples;
  options.gradients = gradients;
  const Rendered r = wale::render(live_.devices(), live_.world(), lit.integrator, options);
  if (r.stopped) throw Stopped{};
  if (const uint64_t count = r.counts.events[W_EVENT_NAN]) bug("fit: {} samples were not finite", count);
  return r.image;
}

PicturePair LitPair::render(const Scene& scene, int samples, uint32_t seed) {
  PicturePair pair;
  for (size_t side = 0; side < 2; ++side)
    if (sides_[side])
      pair.*kSides[side] = part_of(render_side(scene, side, false, samples, seed), "", scene.film.exposure, scene.file);
  return pair;
}

LitPair::WithGradients LitPair::render_with_gradients(const Scene& scene, int samples, uint32_t seed) {
  WithGradients out;
  for (size_t side = 0; side < 2; ++side) {
    if (!sides_[side]) continue;
    const Image image = render_side(scene, side, true, samples, seed);
    out.pictures.*kSides[side] = part_of(image, "", scene.film.exposure, scene.file);
    for (size_t k = 0; k < W_GRADIENT_COUNT; ++k)
      out.by[k].*kSides[side] = part_of(image, kGradientNames[k] + std::string("."), scene.film.exposure, scene.file);
  }
  return out;
}

}  // namespace wale::fit
