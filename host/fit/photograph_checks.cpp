#include "host/fit/photograph_checks.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "geom/error.h"

namespace wale::fit {
namespace {

// Calls visit(x, y) for every pixel that shows the cloth.
template <typename Visit>
void for_cloth(const Image& image, const PhotographOptions& options, const Visit& visit) {
  const Rectangle part = options.crop.value_or(Rectangle{0, 0, image.width, image.height});
  for (int y = part.y; y < part.y + part.height; ++y)
    for (int x = part.x; x < part.x + part.width; ++x)
      if (!options.corners || inside(*options.corners, {x + 0.5, y + 0.5})) visit(x, y);
}

void require_place(const std::optional<Rectangle>& part, const char* what, int width, int height,
                   const std::string& name) {
  if (!part) return;
  const Rectangle& r = *part;
  if (r.x < 0 || r.y < 0 || r.width < 1 || r.height < 1 || r.width > width - r.x || r.height > height - r.y)
    user_error("{}: {}: {} x {} pixels at ({}, {}) do not lie within its {} x {}", name, what, r.width, r.height, r.x,
               r.y, width, height);
}

bool is_positive(double value) { return std::isfinite(value) && value > 0; }

// Stored values from which a pixel is clipped.
double clip_level(const StoredImage& stored, const PhotographOptions& options) {
  if (options.clip_level) return *options.clip_level;
  return stored.integer_bits > 0 ? 1.0 : INFINITY;
}

// "0.3 %", "12 %".
std::string percent(double share) {
  return share < 0.1 ? fmt::format("{:.2g} %", 100 * share) : fmt::format("{:.0f} %", 100 * share);
}

// Counts pixels, and in which of 8 x 8 parts of the picture most of them are.
class Clipped {
 public:
  Clipped(const Image& image, double level) : image_(image), channels_(color_channels(image)), level_(level) {}

  void look_at(int x, int y) {
    ++seen_;
    const float* pixel = image_.at(x, y);
    if (std::none_of(channels_.begin(), channels_.end(), [&](size_t c) { return double(pixel[c]) >= level_; })) return;
    ++clipped_;
    ++parts_[size_t(y) * kParts / size_t(image_.height) * kParts + size_t(x) * kParts / size_t(image_.width)];
  }
  double share() const { return seen_ ? double(clipped_) / double(seen_) : 0; }
  std::string text() const {
    const size_t most = size_t(std::max_element(parts_.begin(), parts_.end()) - parts_.begin());
    const auto centre = [](size_t part, int size) { return int((double(part) + 0.5) * size / kParts); };
    return fmt::format("{} of the cloth's pixels are clipped, most around ({}, {})", percent(share()),
                       centre(most % kParts, image_.width), centre(most / kParts, image_.height));
  }

 private:
  static constexpr size_t kParts = 8;
  const Image& image_;
  std::array<size_t, 3> channels_;
  double level_;
  size_t seen_ = 0, clipped_ = 0;
  std::array<size_t, kParts * kParts> parts_{};
};

}  // namespace

void require_consistent(const PhotographOptions& o, const std::string& name) {
  if (o.grey && o.gains) user_error("{}: grey and gains: give one of them", name);
  if (o.crop && o.corners) user_error("{}: crop and corners: give one of them", name);
  if (!(is_positive(o.grey_reflectance) && o.grey_reflectance <= 1))
    user_error("{}: grey_reflectance: {:g} is not above 0 and up to 1; a photographer's card has 0.18", name,
               o.grey_reflectance);
  if (!is_positive(o.exposure)) user_error("{}: exposure: {:g} is not above 0", name, o.exposure);
  if (o.clip_level && !is_positive(*o.clip_level))
    user_error("{}: clip_level: {:g} is not above 0", name, *o.clip_level);
  if (o.gains)
    for (const double gain : *o.gains)
      if (!is_positive(gain)) user_error("{}: gains: {:g} is not above 0", name, gain);
  constexpr int kMost = 16384;
  if (o.size && (o.size->x < 1 || o.size->y < 1 || o.size->x > kMost || o.size->y > kMost))
    user_error("{}: size: {} x {}; valid: 1 to {} pixels", name, o.size->x, o.size->y, kMost);
}

void require_places(const PhotographOptions& options, int width, int height, const std::string& name) {
  require_place(options.grey, "grey", width, height, name);
  require_place(options.crop, "crop", width, height, name);
  if (!options.corners) return;
  if (const std::string fault = corners_fault(*options.corners, width, height); !fault.empty())
    user_error("{}: corners: {}", name, fault);
}

void require_opaque(const StoredImage& stored, const PhotographOptions& options, const std::string& name) {
  if (stored.alpha < 0) return;
  for_cloth(stored.image, options, [&](int x, int y) {
    if (stored.image.at(x, y)[stored.alpha] < 1)
      user_error("{}: pixel ({}, {}) is transparent; crop to the cloth, or save without alpha", name, x, y);
  });
}

void require_unclipped(const StoredImage& stored, const PhotographOptions& options, const std::string& name,
                       std::vector<std::string>& warnings) {
  const double level = clip_level(stored, options);
  if (options.grey) {
    const Rectangle& r = *options.grey;
    Clipped grey(stored.image, level);
    for (int y = r.y; y < r.y + r.height; ++y)
      for (int x = r.x; x < r.x + r.width; ++x) grey.look_at(x, y);
    if (grey.share() > 0) user_error("{}: grey: {} of it is clipped; expose less", name, percent(grey.share()));
  }
  Clipped cloth(stored.image, level);
  for_cloth(stored.image, options, [&](int x, int y) { cloth.look_at(x, y); });
  if (cloth.share() > kClippedShare) user_error("{}: {}; expose less", name, cloth.text());
  if (cloth.share() > 0) warnings.push_back(fmt::format("{}: {}", name, cloth.text()));
}

void require_light(const Picture& picture, int integer_bits, const std::string& name,
                   std::vector<std::string>& warnings) {
  constexpr double kBlack = 1e-5, kDim = 1e-2;
  const double mean = brightness(picture);
  if (!(mean > kBlack)) user_error("{}: it is black: its mean is {:.1e}", name, mean);
  if (integer_bits == 8 && mean < kDim)
    warnings.push_back(fmt::format(
        "{}: its mean is {:.2g} of full scale, where 8 bits have coarse steps; expose more, or save 16 bits", name,
        mean));
}

void warn_of_size(const PhotographOptions& options, int width, int height, const std::string& name,
                  std::vector<std::string>& warnings) {
  if (!options.size) return;
  const ivec2 shown = options.corners ? size_of(*options.corners)
                      : options.crop  ? ivec2(options.crop->width, options.crop->height)
                                      : ivec2(width, height);
  if (options.size->x > shown.x || options.size->y > shown.y)
    warnings.push_back(fmt::format("{}: size {} x {} is more than the {} x {} pixels of its cloth", name,
                                   options.size->x, options.size->y, shown.x, shown.y));
}

}  // namespace wale::fit
