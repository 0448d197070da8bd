// Random valid tiles: partners are an involution, and stitching loses no curve and takes none twice.
#include <algorithm>
#include <numbers>
#include <random>

#include "geom/stitch.h"
#include "tests/geom/tile_fixtures.h"
#include "tests/property.h"

namespace wale::test {
namespace {

/// Wavy yarns that advance by one period along x or along y, or close on themselves; moved, cut anew at the tile's
/// borders, some pieces stored backwards, all in random order.
Pattern random_tile() {
  Pattern pattern;
  pattern.name = "random";
  pattern.period = {*number_between(0.002, 0.02), *number_between(0.002, 0.02)};
  pattern.yarn_radius = 1e-5;
  pattern.stitches = {1, 1};
  const int yarns = *rc::gen::inRange(1, 5);
  for (int i = 0; i < yarns; ++i) {
    const int kind = *rc::gen::inRange(0, 3), points = *rc::gen::inRange(5, 40);
    const double amplitude = *number_between(0, 0.7), phase = *number_between(0, 6), level = *number_between(0, 1);
    PatternCurve curve;
    curve.closed = kind == 2;
    for (int k = 0; k <= points; ++k) {
      if (curve.closed && k == points) break;
      const double t = double(k) / points, a = 2 * std::numbers::pi * t + phase;
      const dvec2 p = kind == 0   ? dvec2(t + 0.3 * std::sin(2 * a), level + amplitude * std::sin(a))
                      : kind == 1 ? dvec2(level + amplitude * std::sin(a), t + 0.3 * std::sin(2 * a))
                                  : dvec2(level, level) + amplitude * dvec2(std::sin(a), std::cos(a)) + 0.05;
      // Each yarn in a plane of its own: no two ends lie in one place.
      curve.points.emplace_back(p * pattern.period, 1e-3 * i);
    }
    pattern.curves.push_back(curve);
  }
  std::mt19937_64 random(*rc::gen::inRange<uint64_t>(0, 1000000));
  Pattern cut = recut(pattern, dvec2(*number_between(-1, 1), *number_between(-1, 1)) * pattern.period, &random);
  std::shuffle(cut.curves.begin(), cut.curves.end(), random);
  return cut;
}

InstanceRect random_rectangle() {
  InstanceRect rect;
  for (int axis = 0; axis < 2; ++axis) {
    rect.lo[axis] = *rc::gen::inRange(-3, 4);
    rect.hi[axis] = rect.lo[axis] + *rc::gen::inRange(1, 6);
    if (*rc::gen::inRange(0, 3) == 0) rect.wrap[axis] = rect.hi[axis] - rect.lo[axis];
  }
  return rect;
}

TEST(StitchProperty, PartnersOfRandomTilesAreAnInvolution) {
  check_property(200, [] {
    const Pattern pattern = random_tile();
    expect_involution(pattern, match_partners(pattern));
    RC_ASSERT(!::testing::Test::HasFailure());
  });
}

TEST(StitchProperty, StitchingRandomTilesLosesNoCurve) {
  check_property(200, [] {
    const Pattern pattern = random_tile();
    const PartnerMap partners = match_partners(pattern);
    const InstanceRect rect = random_rectangle();
    const std::vector<YarnChain> yarns = stitch(pattern, partners, rect);
    expect_partition(pattern, rect, yarns);
    for (const YarnChain& yarn : yarns)
      for (size_t i = 0; i + 1 < yarn.links.size(); ++i) {
        // Every link goes on where its partner says.
        const Link &from = yarn.links[i], &to = yarn.links[i + 1];
        const Partner& on = partners.of[size_t(from.curve)][from.reversed ? 0 : 1];
        RC_ASSERT(on.to.curve == to.curve);
        RC_ASSERT((on.to.end == 1) == to.reversed);
        RC_ASSERT(from.instance + on.shift == to.instance);
      }
    RC_ASSERT(!::testing::Test::HasFailure());
  });
}

}  // namespace
}  // namespace wale::test
