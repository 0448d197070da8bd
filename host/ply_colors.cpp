#include "host/ply_colors.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "geom/error.h"
#include "host/materials.h"
#include "host/schema.h"
#include "host/thick_layer.h"

namespace wale {
namespace {

/// PCG output function (O'Neill 2014): a number in [-1,1] that belongs to `value`.
double hash(uint32_t value, uint32_t salt) {
  uint32_t state = (value + salt * 0x9e3779b9u) * 747796405u + 2891336453u;
  state = ((state >> ((state >> 28) + 4)) ^ state) * 277803737u;
  state = (state >> 22) ^ state;
  return 2 * (double(state) + 0.5) / 4294967296.0 - 1;
}

int modulo(int a, int b) { return (a % b + b) % b; }

/// Colours that the cloth shows, by place.
class Palette {
 public:
  Palette(const PlyAppearance& yarn, const ColorImage& image, const Image& pixels, const std::vector<Rgb>& yarns)
      : yarn_(yarn), image_(image), pixels_(pixels), yarns_(yarns) {
    for (const Stripe& stripe : yarn.stripes) stripes_ += stripe.length;
    if (image.file.empty()) return;
    for (int y = 0; y < pixels.height; ++y)
      for (int x = 0; x < pixels.width; ++x)
        for (const double v : pixel(x, y))
          if (!(v >= 0 && v <= 1))
            user_error("{}: pixel ({}, {}) has a colour of {:g}; colours of cloth are 0 to 1", image.file.string(), x,
                       y, v);
  }

  /// Nothing where the material's own colour holds.
  std::optional<Rgb> at(const StrandPlace* place, int ply, uint32_t yarn) const {
    if (place && !image_.file.empty())
      if (const auto color = of_stitch(*place)) return color;
    if (place && !yarn_.stripes.empty()) {
      double rest = std::fmod(double(place->along), stripes_);
      if (rest < 0) rest += stripes_;
      for (const Stripe& stripe : yarn_.stripes) {
        if (rest < stripe.length) return stripe.color;
        rest -= stripe.length;
      }
      return yarn_.stripes.back().color;
    }
    if (!yarn_.plies.empty()) return yarn_.plies[size_t(ply) % yarn_.plies.size()];
    if (!yarns_.empty()) return yarns_[yarn % yarns_.size()];
    return std::nullopt;
  }

 private:
  Rgb pixel(int x, int y) const {
    const float* v = pixels_.at(x, y);
    const bool grey = pixels_.channels.size() < 3;
    return {v[0], v[grey ? 0 : 1], v[grey ? 0 : 2]};
  }

  std::optional<Rgb> of_stitch(const StrandPlace& place) const {
    // Pixel of the stitch's middle, counted from the lower left corner.
    dvec2 p(place.stitch);
    p -= image_.origin;
    if (!image_.per_stitch)
      p = (dvec2(place.u, place.v) - image_.origin) / image_.size * dvec2(pixels_.width, pixels_.height);
    const dvec2 whole = glm::floor(p);
    if (!(std::abs(whole.x) < 1e9 && std::abs(whole.y) < 1e9)) return std::nullopt;
    int x = int(whole.x), y = int(whole.y);
    if (image_.repeat) {
      x = modulo(x, pixels_.width);
      y = modulo(y, pixels_.height);
    }
    if (x < 0 || y < 0 || x >= pixels_.width || y >= pixels_.height) return std::nullopt;
    return pixel(x, pixels_.height - 1 - y);
  }

  const PlyAppearance& yarn_;
  const ColorImage& image_;
  const Image& pixels_;
  const std::vector<Rgb>& yarns_;
  double stripes_ = 0;
};

/// Heather of a tint, which can only darken: its factor runs from (1 - spread)/(1 + spread) to 1.
Rgb tinted(const Rgb& color, double hash, double spread) {
  const double factor = (1 + hash * spread) / (1 + spread);
  return {factor * color[0], factor * color[1], factor * color[2]};
}

/// Words of seen colours; each distinct one is converted once.
class Encoder {
 public:
  explicit Encoder(const PlyAppearance& yarn) : material_(ply_material(yarn)), tint_(yarn.forward.has_value()) {
    if (tint_) return;
    layer_.emplace(material_);
    own_ = layer_->seen(Rgb{material_.fibre.x, material_.fibre.y, material_.fibre.z});
    if (yarn.color) own_ = *yarn.color;  // also where no fibre is dark enough
  }

  const Rgb& own() const { return own_; }
  bool tints() const { return tint_; }

  uint32_t word(const Rgb& seen) {
    const auto [found, is_new] = words_.try_emplace(seen, 0);
    if (is_new) found->second = pack_ply_color(tint_ ? seen : layer_->fibre(seen));
    return found->second;
  }

 private:
  WPlyMaterial material_;
  bool tint_;
  std::optional<ThickLayer> layer_;
  Rgb own_{1, 1, 1};
  std::map<Rgb, uint32_t> words_;
};

}  // namespace

bool colors_need_places(const PlyAppearance& yarn, const ColorImage& image) {
  return !yarn.stripes.empty() || !image.file.empty();
}

bool colors_vary(const PlyAppearance& yarn, const ColorImage& image, const std::vector<Rgb>& yarns) {
  return !yarns.empty() || colors_need_places(yarn, image) || !yarn.plies.empty() || yarn.heather_yarn > 0 ||
         yarn.heather_ply > 0;
}

std::vector<Rgb> yarn_colors(const FabricScene& fabric, const Pattern& pattern) {
  if (fabric.palette) return *fabric.palette;
  std::vector<Rgb> out;
  for (const auto& color : pattern.palette) {
    Rgb linear;
    for (size_t k = 0; k < 3; ++k) linear[k] = srgb_to_linear(color[k] / 255.0);
    out.push_back(linear);
  }
  return out;
}

uint32_t pack_ply_color(const Rgb& color) {
  uint32_t word = W_COLOR_GIVEN;
  for (int k = 0; k < 3; ++k) {
    const double q = 1 - std::sqrt(1 - std::clamp(color[k], 0.0, 1.0));
    word |= uint32_t(std::lround(q * W_COLOR_MAX)) << (10 * k);
  }
  return word;
}

Rgb unpack_ply_color(uint32_t word) {
  Rgb color{0, 0, 0};
  for (int k = 0; k < 3; ++k) {
    const double r = 1 - double((word >> (10 * k)) & W_COLOR_MAX) / W_COLOR_MAX;
    color[k] = 1 - r * r;
  }
  return color;
}

Rgb heathered(const Rgb& color, double hash, double spread) {
  const double brightest = std::max({color[0], color[1], color[2]});
  if (brightest <= 0) return color;
  const double factor = 1 + hash * std::min({spread, 1 / brightest - 1, 1.0});
  Rgb out;
  for (int k = 0; k < 3; ++k) out[k] = std::clamp(color[k] * factor, 0.0, 1.0);
  return out;
}

std::vector<uint32_t> bake_ply_colors(const Fabric& fabric, const PlyAppearance& yarn, const ColorImage& image,
                                      const Image& pixels, const std::vector<Rgb>& yarns) {
  const Palette palette(yarn, image, pixels, yarns);
  Encoder encoder(yarn);
  const size_t plies = size_t(fabric.plies);
  const double spread = yarn.heather_yarn + yarn.heather_ply;
  if (colors_need_places(yarn, image) && fabric.place.empty())
    bug("colours of fabric '{}': knitted without places", fabric.name);
  std::vector<uint32_t> words(fabric.anchors.size(), 0);
  for (const PlyRun& run : fabric.runs)
    for (size_t curve = 0; curve < run.plies; ++curve) {
      const size_t p = run.kind == PlyRun::Kind::ply ? curve : run.ply;
      // One number for both parts of the heather: their sum never leaves [-1,1] of the whole spread.
      double heather = 0;
      if (spread > 0)
        heather = (yarn.heather_yarn * hash(run.yarn, 1) +
                   yarn.heather_ply * hash(run.yarn * uint32_t(plies) + uint32_t(p), 2)) /
                  spread;
      std::optional<Rgb> last;
      uint32_t word = 0;
      for (size_t k = 0; k < run.count; ++k) {
        const StrandPlace* place =
            fabric.place.empty() ? nullptr : &fabric.place[run.first_place + (run.one_place ? 0 : k)];
        std::optional<Rgb> color = palette.at(place, int(p), run.color);
        if (!color && spread > 0) color = encoder.own();
        if (color && (k == 0 || color != last))
          word = encoder.word(encoder.tints() ? tinted(*color, heather, spread) : heathered(*color, heather, spread));
        last = color;
        if (color) words[run.first_vertex + curve * run.count + k] = word;
      }
    }
  return words;
}

}  // namespace wale
