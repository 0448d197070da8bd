// A scene of any size, place and attitude makes one picture.
#include <cmath>

#include "tests/hard/fixtures_transforms.h"
#include "tests/hard/look_picture.h"
#include "tests/property.h"
#include "tests/tolerances.h"

namespace wale::test {
namespace {

// What differs is the seed's noise in other places, of the same size: the RMS difference of two independent pictures is
// that of their noise, and 24 x 24 pixels of 3 channels estimate it to a few per cent.
TEST(Invariance, RandomSimilaritiesMakeOnePicture) {
  constexpr int kPixels = 24, kSpp = 64;
  const Picture plain = take(draped_scene({}, kPixels), kSpp, 1);
  check_property(6, [&] {
    Similarity at;
    at.scale = std::pow(10.0, *number_between(-4, 4));
    at.turn = rotation(dvec3(*number_between(-1, 1), *number_between(-1, 1), 1), *number_between(0, 6.28));
    at.move =
        at.scale * kSceneSize * 1e4 * dvec3(*number_between(-1, 1), *number_between(-1, 1), *number_between(-1, 1));
    const Finding found = look_at_difference(plain, take(draped_scene(at, kPixels), kSpp, 1));
    RC_LOG() << "scale " << at.scale << ": " << found.error_float << " of the noise;" << found.broken;
    RC_ASSERT(found.broken.empty());
    RC_ASSERT(found.error_float < 1.2);
    RC_ASSERT(found.rare == 0u);
  });
}

}  // namespace
}  // namespace wale::test
