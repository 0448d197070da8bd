// Points by place: none within reach may be missed and none seen twice, at any distance from the origin.
#include "geom/near_points.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <set>

namespace wale {
namespace {

std::set<int> seen_from(const NearPoints& points, const dvec3& p) {
  std::set<int> seen;
  points.visit_near(p, [&](int number) { EXPECT_TRUE(seen.insert(number).second) << number << " seen twice"; });
  return seen;
}

// From a reach of 1e-9 of the coordinates' size to one below their rounding, where a cube holds a single number or
// none.
TEST(NearPoints, AllWithinReachAreSeenOnce) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> within(-1, 1);
  for (const double size : {0.0, 1.0, 1e9, 0x1p50, 2e15, 4e15, 0x1p53, 0x1p54, 0x1p55, 4e16, 1e30}) {
    const double reach = 1;
    std::vector<dvec3> places;
    NearPoints points(reach);
    for (int i = 0; i < 300; ++i) {
      const dvec3 p = dvec3(size, -size, 0) + 3.0 * dvec3(within(random), within(random), within(random));
      points.add(p, static_cast<int>(places.size()));
      places.push_back(p);
    }
    size_t found = 0;
    for (const dvec3& p : places) {
      const std::set<int> seen = seen_from(points, p);
      for (size_t i = 0; i < places.size(); ++i)
        if (glm::distance(places[i], p) <= reach) {
          EXPECT_TRUE(seen.count(static_cast<int>(i))) << "at " << size << ": " << i;
          ++found;
        }
    }
    EXPECT_GE(found, places.size());
  }
}

TEST(NearPoints, BothZerosAreOnePlace) {
  NearPoints points(1);
  points.add({-0.0, -0.0, -0.0}, 7);
  EXPECT_EQ(seen_from(points, {0.0, 0.0, 0.0}), std::set<int>{7});
}

// What is a thousand reaches away costs no visit, or a search through all would do.
TEST(NearPoints, FarPointsAreNotVisited) {
  NearPoints points(0.001);
  for (int i = 0; i < 1000; ++i) points.add({i, 0, 0}, i);
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(seen_from(points, dvec3(i, 0, 0)), std::set<int>{i});
}

TEST(NearPoints, LargestNumbersEnd) {
  NearPoints points(1e-300);
  const double most = std::numeric_limits<double>::max();
  points.add({most, -most, 0}, 1);
  EXPECT_EQ(seen_from(points, {most, -most, 0}), std::set<int>{1});
  EXPECT_TRUE(seen_from(points, {0, 0, 0}).empty());
}

}  // namespace
}  // namespace wale
