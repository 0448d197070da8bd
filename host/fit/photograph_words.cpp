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
  if (!front) return out;  // a card does not let light through: what it says of the front holds for both
  if (!args.grey.empty()) out.grey = rectangle(args.grey, "--grey");
  out.grey_reflectance = args.grey_reflectance;
  if (!args.gains.empty()) {
    const std::vector<double> v = numbers(args.gains, 3, "--gains", "1.9,1,1.4 (red, green, blue)");
    out.gains = std::array{v[0], v[1], v[2]};
  }
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
  PhotographOptions options = photograph_options(args, true);
  options.exposure = front ? args.front_exposure : args.back_exposure;
  Photograph one = read_photograph(front ? args.front : args.back, options);
  warnings.insert(warnings.end(), one.warnings.begin(), one.warnings.end());
  PicturePair out;
  (front ? out.front : out.back) = std::move(one.picture);
  return out;
}

}  // namespace wale::fit
