#include "host/fit/photograph_words.h"

#include <charconv>
#include <cmath>

#include "geom/error.h"

namespace wale::fit {
namespace {

// `count` numbers with commas between them.
std::vector<double> numbers(const std::string& text, size_t count, const char* option, const char* example) {
  std::vector<double> out;
  const char *at = text.data(), *end = at + text.size();
  bool good = true;
  while (good && at <= end) {
    double value = 0;
    const auto [next, error] = std::from_chars(at, end, value);
    good = error == std::errc() && std::isfinite(value) && (next == end || *next == ',');
    out.push_back(value);
    at = next + 1;
  }
  if (!good || out.size() != count)
    user_error("{}: '{}': {} numbers with commas between them are needed, for example {}", option, text, count,
               example);
  return out;
}

Rectangle rectangle(const std::string& text, const char* option) {
  const std::vector<double> v = numbers(text, 4, option, "100,80,640,640 (x, y, width, height in pixels)");
  for (const double n : v)
    if (n != std::floor(n) || std::abs(n) > 1e6) user_error("{}: {:g}: whole pixels are needed", option, n);
  return {int(v[0]), int(v[1]), int(v[2]), int(v[3])};
}

// What a card or the user says of the light. Gains of a command line are by themselves factors on the file's linear
// values, whatever its exposure; a library's are factors on those values over the exposure.
void take_reference(PhotographOptions& options, const FitArgs& args) {
  if (!args.grey.empty()) options.grey = rectangle(args.grey, "--grey");
  options.grey_reflectance = args.grey_reflectance;
  if (options.grey && args.gains.empty()) return;
  std::vector<double> gains = {1, 1, 1};
  if (!args.gains.empty()) gains = numbers(args.gains, 3, "--gains", "1.9,1,1.4 (red, green, blue)");
  for (const double gain : gains)
    if (!(gain > 0)) user_error("--gains: {:g} is not above 0", gain);
  options.gains = std::array{gains[0] * options.exposure, gains[1] * options.exposure, gains[2] * options.exposure};
}

}  // namespace

PhotographOptions photograph_options(const FitArgs& args, bool front) {
  PhotographOptions out;
  if (args.transfer == "srgb") out.transfer = Transfer::srgb;
  if (args.transfer == "linear") out.transfer = Transfer::linear;
  out.exposure = front ? args.front_exposure : args.back_exposure;
  if (args.clip_level > 0) out.clip_level = args.clip_level;
  if (!args.crop.empty()) out.crop = rectangle(args.crop, "--crop");
  if (!args.corners.empty()) {
    const std::vector<double> v =
        numbers(args.corners, 8, "--corners", "12,9,500,14,492,480,20,470 (x,y of top left, then clockwise)");
    Corners corners;
    for (size_t i = 0; i < 4; ++i) corners[i] = {v[2 * i], v[2 * i + 1]};
    out.corners = corners;
  }
  // A card does not let light through: what it says of the front holds for both.
  if (front || args.front.empty()) take_reference(out, args);
  return out;
}

PicturePair read_photographs(const FitArgs& args, std::vector<std::string>& warnings) {
  if (!args.front.empty() && !args.back.empty()) {
    PhotographPair pair =
        read_pair(args.front, args.back, {photograph_options(args, true), photograph_options(args, false)});
    warnings.insert(warnings.end(), pair.warnings.begin(), pair.warnings.end());
    return std::move(pair.pictures);
  }
  const bool front = !args.front.empty();
  if (!front && !args.grey.empty())
    user_error(
        "--grey: a card lets no light through, so it is measured in the front photograph, which is not given; "
        "--gains gives its three numbers");
  Photograph one = read_photograph(front ? args.front : args.back, photograph_options(args, front));
  warnings.insert(warnings.end(), one.warnings.begin(), one.warnings.end());
  PicturePair out;
  (front ? out.front : out.back) = std::move(one.picture);
  return out;
}

}  // namespace wale::fit
