// The search for a loop length, among fabrics of which it is known how the relaxation of each length ends.
#include "geom/chart/gauge_search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

namespace wale {
namespace {

struct Search {
  KnittedTile found;
  std::vector<double> lengths;  // that were tried, in yarn diameters
};

using EndOfTry = std::function<RelaxEnd(double length, int tries)>;

// `wales`: per yarn diameter, by the loop's length in diameters; `wanted` is one of it.
Search search(const std::function<double(double)>& wales, double wanted, const EndOfTry& end_of_try) {
  Search out;
  KnitSettings settings;
  settings.wales = wanted / settings.yarn_thickness;
  out.found = knit_to_gauge(settings,
                            [&](double length, const KnitSettings&, const auto&) {
                              out.lengths.push_back(length);
                              KnittedTile tile;
                              tile.relaxed.end = end_of_try(length, int(out.lengths.size()));
                              tile.relaxed.converged = tile.relaxed.end == RelaxEnd::at_rest;
                              tile.loop_length = length * settings.yarn_thickness;
                              tile.gauge = dvec2(wales(length) / settings.yarn_thickness, 1000);
                              return tile;
                            },
                            {});
  return out;
}

// A fabric of 3.3 / L wales per yarn diameter at a loop of L diameters, not quite in proportion. `wanted`: loop length
// whose gauge is asked for.
Search search(double wanted, const EndOfTry& end_of_try) {
  return search([](double length) { return 3.3 / length * (length > 15 ? 0.97 : 1); }, 3.3 / wanted, end_of_try);
}

// One that is longer than a loop that came to rest is no reason to look no further below it.
TEST(GaugeSearch, ALongLoopThatFailsForbidsNoShorterOne) {
  for (const RelaxEnd end : {RelaxEnd::steps, RelaxEnd::stuck}) {
    // The gauge of 16.49 diameters is that of 17 in proportion, which fails.
    const Search s = search(17, [&](double length, int) { return length > 16.8 ? end : RelaxEnd::at_rest; });
    EXPECT_EQ(s.found.gauge_end, GaugeEnd::reached) << int(end);
    EXPECT_NEAR(s.found.loop_length, 16.49e-3, 0.1e-3);
    EXPECT_LE(s.lengths.size(), 6u);
  }
}

// Nor is it one where the nearest that came to rest is longer still: there is a way from the shorter ones.
TEST(GaugeSearch, ALoopThatFailsBetweenTwoForbidsNoneFromTheOtherSide) {
  // 13.2 and 17.2 come to rest, and the way between them leads to 16.2, but the gauge is that of 16.0.
  const auto wales = [](double length) {
    const double slope = length < 16 ? std::log(17.2 / 13.2) / std::log(16 / 13.2) : 0.0774 / std::log(17.2 / 16);
    return 0.2 * std::pow(length / 16, -slope);
  };
  for (const RelaxEnd end : {RelaxEnd::steps, RelaxEnd::stuck}) {
    const Search s = search(
        wales, 0.2, [&](double length, int) { return length > 16.17 && length < 16.6 ? end : RelaxEnd::at_rest; });
    ASSERT_GE(s.lengths.size(), 4u);
    const std::vector<double> first = {13.2, 17.2, 16.2};
    for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(s.lengths[i], first[i], 0.01);
    EXPECT_EQ(s.found.gauge_end, GaugeEnd::reached) << int(end);
    EXPECT_NEAR(s.found.loop_length, 16e-3, 0.17e-3);
  }
}

// And where the gauge lies beyond it, the search ends, with the reason.
TEST(GaugeSearch, WhatLiesBeyondALoopThatFailsIsNotFound) {
  for (const auto& [end, why] : {std::pair{RelaxEnd::steps, GaugeEnd::steps}, {RelaxEnd::stuck, GaugeEnd::stuck}}) {
    const Search s = search(25, [&](double length, int) { return length > 16.8 ? end : RelaxEnd::at_rest; });
    EXPECT_EQ(s.found.gauge_end, why);
    EXPECT_TRUE(s.found.relaxed.converged) << "the nearest";
    EXPECT_GT(s.found.loop_length, 16e-3);
  }
}

// The shortest that does not jam is looked for from both sides.
TEST(GaugeSearch, JamsBoundItFromBelow) {
  const Search s = search(9, [](double length, int) { return length < 12 ? RelaxEnd::jammed : RelaxEnd::at_rest; });
  EXPECT_EQ(s.found.gauge_end, GaugeEnd::none);
  EXPECT_NEAR(s.found.loop_length, 12.2e-3, 0.3e-3);
}

// Nothing is known of the gauge but how near the first one came.
TEST(GaugeSearch, TimeThatEndsItIsSaid) {
  const Search s = search(16, [](double, int tries) { return tries == 2 ? RelaxEnd::time : RelaxEnd::at_rest; });
  EXPECT_TRUE(s.found.relaxed.converged) << "the nearest";
  EXPECT_EQ(s.found.gauge_end, GaugeEnd::time);
  EXPECT_EQ(s.found.tries, 2);
}

// The first jams, and what ended the second is why there is nothing.
TEST(GaugeSearch, OfLoopsThatAllFailedTheLastIsKept) {
  for (const auto& [end, why] : {std::pair{RelaxEnd::time, GaugeEnd::time}, {RelaxEnd::steps, GaugeEnd::steps}}) {
    const Search s = search(16, [&](double, int tries) { return tries == 1 ? RelaxEnd::jammed : end; });
    EXPECT_FALSE(s.found.relaxed.converged);
    EXPECT_EQ(s.found.gauge_end, why);
    EXPECT_EQ(s.found.relaxed.end, end);
  }
}

}  // namespace
}  // namespace wale
