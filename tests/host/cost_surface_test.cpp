// Distances from the surface of plies with known answers.
#include <cmath>

#include "host/cost/ply_surface_distance.h"
#include "tests/temporary_folder.h"

namespace wale::cost {
namespace {

constexpr double kRadius = 1e-4, kExact = 1e-9;  // radii: rounding of doubles

TEST(PlySurfaceDistance, StraightPly) {
  const PlySurface surface({{{{0, 0, 0}, {1e-3, 0, 0}, {2e-3, 0, 0}}, kRadius, false}});
  EXPECT_NEAR(surface.radii_from({0.7e-3, kRadius, 0}), 0, kExact);
  EXPECT_NEAR(surface.radii_from({1e-3, 0, -1.3 * kRadius}), 0.3, kExact);
  EXPECT_NEAR(surface.radii_from({1.5e-3, 0.4 * kRadius, 0}), 0.6, kExact);  // inside
  EXPECT_NEAR(surface.radii_from({-0.9 * kRadius, 0, 0}), 0.1, kExact);      // the cap's sphere
  EXPECT_NEAR(surface.radii_from({1e-3, 50 * kRadius, 0}), 49, 1e-6);        // beyond the reach of the search
}

// A mitre of 90 degrees: its outer edge is farther from the joint than the radius, and lies on the surface.
TEST(PlySurfaceDistance, MitresBelongToIt) {
  const PlySurface surface({{{{-1e-3, 0, 0}, {0, 0, 0}, {0, 1e-3, 0}}, kRadius, false}});
  EXPECT_NEAR(surface.radii_from({kRadius, -kRadius, 0}), 0, kExact);
  EXPECT_NEAR(surface.radii_from({0.9 * kRadius, -kRadius, 0}), 0, kExact);
  EXPECT_NEAR(surface.radii_from({-0.5e-3, -kRadius, 0}), 0, kExact);
  EXPECT_NEAR(surface.radii_from({0.5 * kRadius, -0.5 * kRadius, 0}), 0.5, kExact);  // within it
}

// The first and last edge of a closed yarn turn its mitres and are no surface.
TEST(PlySurfaceDistance, GhostEdgesAreNot) {
  const std::vector<dvec3> points = {{-1e-3, 0, 0}, {0, 0, 0}, {1e-3, 0, 0}, {2e-3, 0, 0}};
  const dvec3 beside_ghost{-0.5e-3, kRadius, 0};
  EXPECT_NEAR(PlySurface({{points, kRadius, false}}).radii_from(beside_ghost), 0, kExact);
  EXPECT_GT(PlySurface({{points, kRadius, true}}).radii_from(beside_ghost), 1);
}

TEST(PlySurfaceDistance, OpenEndsAreKnown) {
  const std::vector<dvec3> points = {{0, 0, 0}, {5e-3, 0, 0}, {10e-3, 0, 0}, {15e-3, 0, 0}};
  const PlySurface open({{points, kRadius, false}}), closed({{points, kRadius, true}});
  EXPECT_TRUE(open.near_open_end({15.9e-3, 0, 0}));
  EXPECT_TRUE(open.near_open_end({0.5e-3, kRadius, 0}));
  EXPECT_FALSE(open.near_open_end({7e-3, kRadius, 0}));
  EXPECT_FALSE(closed.near_open_end({15.9e-3, 0, 0}));
}

TEST(PlySurfaceDistance, TheNearestPlyCounts) {
  const PlySurface surface({{{{0, 0, 0}, {1e-3, 0, 0}}, kRadius, false},
                            {{{0, 3 * kRadius, 0}, {1e-3, 3 * kRadius, 0}}, 2 * kRadius, false}});
  EXPECT_NEAR(surface.radii_from({0.5e-3, 4.8 * kRadius, 0}), 0.1, kExact);  // in radii of the thicker one
}

}  // namespace
}  // namespace wale::cost
