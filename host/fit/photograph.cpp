#include "host/fit/photograph.h"

#include <algorithm>
#include <cmath>

#include "geom/error.h"
#include "host/fit/photograph_checks.h"
#include "host/stored_image.h"

namespace wale::fit {
namespace {

// sRGB or linear, as the user or else the file says.
void make_linear(StoredImage& stored, const std::optional<Transfer>& transfer) {
  if (transfer ? *transfer == Transfer::srgb : stored.srgb) decode_srgb(stored);
}

std::array<double, 3> mean_of(const Picture& picture, const Rectangle& part) {
  std::array<double, 3> mean{};
  for (int y = part.y; y < part.y + part.height; ++y)
    for (int x = part.x; x < part.x + part.width; ++x)
      for (size_t c = 0; c < 3; ++c) mean[c] += double(picture.at(x, y)[c]);
  for (double& m : mean) m /= double(part.width) * part.height;
  return mean;
}

// Standard deviation over mean, the greatest of the three channels.
double unevenness(const Picture& picture, const Rectangle& part, const std::array<double, 3>& mean) {
  double worst = 0;
  for (size_t c = 0; c < 3; ++c) {
    double squares = 0;
    for (int y = part.y; y < part.y + part.height; ++y)
      for (int x = part.x; x < part.x + part.width; ++x) squares += std::pow(double(picture.at(x, y)[c]) - mean[c], 2);
    worst = std::max(worst, std::sqrt(squares / (double(part.width) * part.height)) / mean[c]);
  }
  return worst;
}

// Gains that make the reference its reflectance.
std::array<double, 3> gains_of_grey(const Picture& linear, const PhotographOptions& options, const std::string& name,
                                    std::vector<std::string>& warnings) {
  constexpr double kUneven = 0.1, kLeast = 1e-3;
  const Rectangle& grey = *options.grey;
  const std::array<double, 3> mean = mean_of(linear, grey);
  for (size_t c = 0; c < 3; ++c)
    if (!(mean[c] > kLeast))
      user_error("{}: grey: its {} is {:.2g} of full scale, too dark to measure by; expose more", name, "RGB"[c],
                 mean[c]);
  if (const double deviation = unevenness(linear, grey, mean); deviation > kUneven)
    warnings.push_back(
        fmt::format("{}: grey: varies by {:.0f} %; is it all on the card, and in focus?", name, 100 * deviation));
  std::array<double, 3> gains{};
  for (size_t c = 0; c < 3; ++c) gains[c] = options.grey_reflectance * options.exposure / mean[c];
  return gains;
}

Photograph read(const std::filesystem::path& file, const PhotographOptions& options,
                const std::array<double, 3>& other_gains) {
  constexpr int kFewPixels = 64;
  const std::string name = file.string();
  require_consistent(options, name);
  StoredImage stored = read_stored_image(file);
  require_places(options, stored.image.width, stored.image.height, name);
  Photograph photograph;
  warn_of_size(options, stored.image.width, stored.image.height, name, photograph.warnings);
  require_opaque(stored, options, name);
  require_unclipped(stored, options, name, photograph.warnings);
  make_linear(stored, options.transfer);
  const Picture linear = picture_of(stored.image, name);
  const int bits = stored.integer_bits;
  stored = {};
  photograph.gains = options.gains  ? *options.gains
                     : options.grey ? gains_of_grey(linear, options, name, photograph.warnings)
                                    : other_gains;
  Picture& picture = photograph.picture;
  if (options.corners) {
    const ivec2 size = options.size.value_or(size_of(*options.corners));
    picture = rectified(linear, *options.corners, size.x, size.y);
  } else {
    picture = options.crop ? cropped(linear, *options.crop) : linear;
    if (options.size) picture = at_resolution(picture, options.size->x, options.size->y);
  }
  require_light(picture, bits, name, photograph.warnings);
  for (size_t i = 0; i < picture.pixels.size(); ++i)
    picture.pixels[i] = float(double(picture.pixels[i]) * photograph.gains[i % 3] / options.exposure);
  if (std::min(picture.width, picture.height) < kFewPixels)
    photograph.warnings.push_back(
        fmt::format("{}: {} x {} pixels of cloth show little of its stitches", name, picture.width, picture.height));
  return photograph;
}

// Whether the files show the same, whatever gains and exposure each was given.
bool same_values(const Photograph& a, double a_exposure, const Photograph& b, double b_exposure) {
  constexpr double kRounding = 1e-5;  // of floats that were scaled
  for (size_t i = 0; i < a.picture.pixels.size(); ++i) {
    const double x = double(a.picture.pixels[i]) * a_exposure / a.gains[i % 3];
    const double y = double(b.picture.pixels[i]) * b_exposure / b.gains[i % 3];
    if (std::abs(x - y) > kRounding * std::max(std::abs(x), std::abs(y))) return false;
  }
  return true;
}

}  // namespace

Photograph read_photograph(const std::filesystem::path& file, const PhotographOptions& options) {
  return read(file, options, {1, 1, 1});
}

PhotographPair read_pair(const std::filesystem::path& front_file, const std::filesystem::path& back_file,
                         const PairOptions& options) {
  constexpr double kNoLight = 1e-4, kLittleLight = 1e-2;
  Photograph front = read_photograph(front_file, options.front);
  Photograph back = read(back_file, options.back, front.gains);
  const std::string name = back_file.string();
  if (front.picture.width != back.picture.width || front.picture.height != back.picture.height)
    user_error("{}: {} x {} pixels, but {} has {} x {}; crop both alike, or give a size", name, back.picture.width,
               back.picture.height, front_file.string(), front.picture.width, front.picture.height);
  if (same_values(front, options.front.exposure, back, options.back.exposure))
    user_error("{}: the same picture as {}; one lit from behind is needed", name, front_file.string());
  const double share = brightness(back.picture) / brightness(front.picture);
  if (!(share >= kNoLight))
    user_error("{}: no light comes through: its mean is {:.1e} of the front's; was the lamp behind on?", name, share);
  PhotographPair pair{{std::move(front.picture), std::move(back.picture)}, std::move(front.warnings)};
  pair.warnings.insert(pair.warnings.end(), back.warnings.begin(), back.warnings.end());
  if (share < kLittleLight)
    pair.warnings.push_back(
        fmt::format("{}: its mean is {:.2g} of the front's; give its exposure if it is longer", name, share));
  return pair;
}

}  // namespace wale::fit
