#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "geom/error.h"
#include "tests/hard/fixtures_transforms.h"
#include "tests/hard/look_picture.h"
#include "tests/hard/look_refusal.h"
#include "tests/hard/trap.h"
#include "tests/tolerances.h"

namespace wale::test {
namespace {

constexpr int kPixels = 24, kSpp = 64;

// The plain scene's picture, rendered once.
const Picture& plain() {
  static const Picture picture = take(draped_scene({}, kPixels), kSpp, 1);
  return picture;
}

Finding look_at_similar(const std::vector<Similarity>& places) {
  std::vector<Finding> found;
  for (const Similarity& at : places) {
    found.push_back(look_at_difference(plain(), take(draped_scene(at, kPixels), kSpp, 1)));
    if (!found.back().broken.empty())
      found.back().broken =
          fmt::format(" at scale {:g}, {:g} m away:{}", at.scale, glm::length(at.move), found.back().broken);
  }
  return worst_of(found);
}

// Powers of two leave every mantissa alone: what differs is a constant that has a length.
Finding look_at_powers_of_two() {
  Finding found;
  found.error_float = 0;
  for (const double scale : {std::ldexp(1.0, -13), std::ldexp(1.0, 13)}) {
    const Picture other = take(draped_scene({scale, dmat3(1.0), dvec3(0)}, kPixels), kSpp, 1);
    found.trials += other.counts.paths;
    const size_t stride = other.image.channels.size();
    size_t differ = 0;
    for (size_t i = 0; i < other.image.pixels.size(); i += stride)
      differ += !std::equal(&other.image.pixels[i], &other.image.pixels[i] + 3, &plain().image.pixels[i]);
    found.error_float = std::max(found.error_float, double(differ) / (kPixels * kPixels));
  }
  return found;
}

Trap similar(const std::string& name, const std::string& breaks, const std::vector<Similarity>& places) {
  return {name,
          breaks,
          "the picture of the same seed changes by less than its noise, in every pixel",
          "of the noise",
          tolerance::kLessThanNoise,
          0,
          [places] { return look_at_similar(places); }};
}

}  // namespace

std::vector<Trap> distance_traps() {
  const dmat3 one(1.0);
  const dvec3 far = 1e4 * kSceneSize * glm::normalize(dvec3(0.7, -0.5, 0.3));
  const dmat3 turn = rotation(dvec3(1, 2, -0.5), 2.1);
  return {
      similar("scene scaled", "constants with a length: offsets, epsilons, least areas",
              {{1e-4, one, dvec3(0)}, {1e-2, one, dvec3(0)}, {1e4, one, dvec3(0)}}),
      {"scene scaled by powers of two", "constants with a length, seen in the last bit",
       "scaled by 2^-13 and 2^13, all but one pixel in a hundred are the same to the last bit", "of the pixels",
       tolerance::kPixelsOfAnotherScale, 0, look_at_powers_of_two},
      similar("scene far from 0", "floats lose the cloth 1e4 sizes from 0", {{1, one, far}, {1, one, -100.0 * far}}),
      similar("scene turned", "axes that the code prefers", {{1, turn, dvec3(0)}}),
      similar("scene scaled, turned and moved", "all of these together", {{3e-3, turn, dvec3(5, -3, 8)}}),
      {"cloths too far apart", "floats cannot place both, and plies become lumps",
       "5 m apart they are rendered; 1 km apart the scene is refused with one line that says how far is possible",
       "wrong answers", 0, 0,
       [] {
         return look_at_answers(
             {{"5 m apart", [] { build_scene(two_cloths_apart(5)); }, ""},
              {"1 km apart", [] { build_scene(two_cloths_apart(1000)); }, "bring the fabrics to within"}});
       }},
      {"camera too far away", "rays of neighbouring pixels are the same float",
       "an angle of view of 0.01 degrees is rendered at 24 pixels; pixels finer than floats are refused with one line",
       "wrong answers", 0, 0,
       [] {
         return look_at_answers(
             {{"24 pixels", [] { build_scene(seen_from_afar(0.01 * M_PI / 180, 24)); }, ""},
              {"65536 pixels", [] { build_scene(seen_from_afar(0.01 * M_PI / 180, 65536)); }, "pixels"}});
       }},
  };
}

}  // namespace wale::test
