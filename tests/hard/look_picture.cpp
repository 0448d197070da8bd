#include "tests/hard/look_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tests/tolerances.h"

namespace wale::test {

namespace {

/// The picture and its variance in units of a radiance: 1e30 and 1e-30 have squares beyond floats.
Image relative(Image image, double radiance) {
  const size_t stride = image.channels.size();
  for (size_t i = 0; i < image.pixels.size(); ++i) {
    const bool variance = i % stride >= 3 && i % stride < 6;
    if (i % stride < 6) image.pixels[i] = float(image.pixels[i] / radiance / (variance ? radiance : 1));
  }
  return image;
}

}  // namespace

Finding worst_of(const std::vector<Finding>& all) {
  Finding worst;
  worst.error_float = 0;
  for (const Finding& f : all) {
    worst.error_float = std::max(worst.error_float, f.error_float);
    worst.trials += f.trials;
    worst.rare += f.rare;
    worst.broken += f.broken;
  }
  return worst;
}

Finding look_for_finite(const Picture& picture) {
  Finding found;
  found.trials = picture.counts.paths;
  found.rare = bad_events(picture.counts);
  size_t bad = 0;
  for (const float v : picture.image.pixels) bad += !std::isfinite(v);
  found.error_float = double(bad);
  if (bad) found.broken = fmt::format("{} values are not finite", bad);
  return found;
}

Finding look_at_constant(const Scene& scene, double expected, int spp) {
  const Picture picture = take(scene, spp, 1);
  Finding found = look_for_finite(picture);
  size_t tests = 0;
  const double p = smallest_p(relative(picture.image, expected), 1.0, tests);
  found.error_float = 0;
  for (const double mean : mean_rgb(picture.image))
    found.error_float = std::max(found.error_float, std::abs(mean / expected - 1));
  if (!(p > sidak(tolerance::kFamilyP, tests)))
    found.broken += fmt::format(" a pixel lies outside its noise, p = {:.2g} of {}; the mean is off by {:.2g}", p,
                                tests, found.error_float);
  if (!(picture.counts.bounce > 0)) found.broken += " nothing was met";
  return found;
}

Finding look_at_difference(const Picture& a, const Picture& b) {
  Finding found = look_for_finite(b);
  size_t tests = 0;
  const double p = smallest_p(a.image, b.image, tests);
  double difference = 0, noise = 0;
  for (int y = 0; y < a.image.height; ++y)
    for (int x = 0; x < a.image.width; ++x)
      for (int c = 0; c < 3; ++c) {
        const float *v = a.image.at(x, y), *w = b.image.at(x, y);
        difference += (double(v[c]) - w[c]) * (double(v[c]) - w[c]);
        noise += double(v[3 + c]) + w[3 + c];
      }
  found.error_float = std::sqrt(difference / noise);
  if (!(p > sidak(tolerance::kFamilyP, tests)))
    found.broken += fmt::format(" a pixel differs by more than its noise, p = {:.2g} of {} pixels", p, tests);
  return found;
}

}  // namespace wale::test
