#include "geom/stitch.h"

#include "tests/geom/tile_fixtures.h"

namespace wale {
namespace {

using namespace test;

TEST(MatchPartners, InvolutionUnderRandomTranslations) {
  const Pattern tile = two_row_tile();
  const size_t points = 2 * (tile.curves[0].points.size() - 1);
  for (uint64_t seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> unit(-1, 1);
    const dvec2 by(unit(random) * tile.period.x, unit(random) * tile.period.y);
    const Pattern cut = recut(tile, by, &random);
    const PartnerMap map = match_partners(cut);
    expect_involution(cut, map);
    EXPECT_LT(map.worst_distance, 1e-15);
    const std::vector<YarnChain> yarns = tile_yarns(cut, map);
    ASSERT_EQ(yarns.size(), 2u);
    size_t kept = 0;
    for (const YarnChain& yarn : yarns) {
      EXPECT_EQ(yarn.shift, ivec2(1, 0));
      kept += cycle_points(cut, yarn).size();
    }
    EXPECT_EQ(kept, points);
    const InstanceRect rect{{-2, 3}, {1, 5}, {0, 0}};
    expect_partition(cut, rect, stitch(cut, map, rect));
  }
}

TEST(MatchPartners, JitteredEndsStillPair) {
  std::mt19937_64 random(7);
  Pattern cut = recut(two_row_tile(), {0.0003, 0.0011}, &random);
  ASSERT_GT(cut.curves.size(), 2u);
  std::uniform_real_distribution<double> jitter(-0.1 * cut.yarn_radius, 0.1 * cut.yarn_radius);
  for (PatternCurve& curve : cut.curves) curve.points.back() += dvec3(jitter(random), jitter(random), jitter(random));
  const PartnerMap map = match_partners(cut);
  expect_involution(cut, map);
  EXPECT_GT(map.worst_distance, 0.01 * cut.yarn_radius);
  EXPECT_EQ(tile_yarns(cut, map).size(), 2u);
}

TEST(MatchPartners, UnmatchedEndIsNamed) {
  Pattern tile = two_row_tile();
  tile.curves[1].points.back().y += 0.0004;
  expect_user_error([&] { match_partners(tile); }, {"two rows", "curve 1", "no partner within", "0.0004 m away"});
}

TEST(MatchPartners, ToleranceIsHonoured) {
  Pattern tile = two_row_tile();
  tile.curves[1].points.back().y += 0.00001;
  EXPECT_NEAR(match_partners(tile, 0.00002).worst_distance, 0.00001, 1e-12);
  expect_user_error([&] { match_partners(tile, 0.000005); }, {"no partner within 5e-06 m"});
}

TEST(MatchPartners, EndClaimedTwiceIsNamed) {
  Pattern tile = two_row_tile();
  PatternCurve stray = tile.curves[0];  // begins where curve 0 does
  tile.curves.push_back(stray);
  expect_user_error([&] { match_partners(tile); }, {"two rows", "which another curve claims too", "curve 2"});
}

TEST(TileYarns, BackwardYarnIsTurnedToPlusX) {
  const Pattern tile = two_row_tile();
  const std::vector<YarnChain> yarns = tile_yarns(tile, match_partners(tile));
  ASSERT_EQ(yarns.size(), 2u);
  EXPECT_FALSE(yarns[0].links[0].reversed);
  EXPECT_TRUE(yarns[1].links[0].reversed);
  EXPECT_EQ(yarns[1].shift, ivec2(1, 0));
}

TEST(TileYarns, TurnedCyclesKeepTheirPlace) {
  // A yarn of several pieces, all stored backwards, is the same curve as before.
  Pattern forward = recut(stockinette_pattern(), {0.0003, 0.0004});
  Pattern backward = forward;
  for (PatternCurve& curve : backward.curves) std::reverse(curve.points.begin(), curve.points.end());
  ASSERT_GT(forward.curves.size(), 2u);
  const auto a = cycle_points(forward, tile_yarns(forward, match_partners(forward))[0]);
  const auto b = cycle_points(backward, tile_yarns(backward, match_partners(backward))[0]);
  ASSERT_EQ(a.size(), b.size());
  for (size_t i = 0; i < a.size(); ++i) EXPECT_LT(glm::distance(a[i], b[i]), 1e-15);
}

TEST(Stitch, RowsBecomeFullYarns) {
  const Pattern tile = recut(two_row_tile(), {0.0003, 0.0011});
  const PartnerMap map = match_partners(tile);
  const InstanceRect rect{{0, 0}, {5, 3}, {0, 0}};
  const std::vector<YarnChain> yarns = stitch(tile, map, rect);
  expect_partition(tile, rect, yarns);
  for (const YarnChain& yarn : yarns) {
    EXPECT_FALSE(yarn.closed);
    // Each link begins where the one before ends.
    for (size_t i = 1; i < yarn.links.size(); ++i) {
      const auto end = [&](const Link& link, bool last) {
        const auto& p = tile.curves[link.curve].points;
        return (last != link.reversed ? p.back() : p.front()) +
               dvec3(link.instance.x * tile.period.x, link.instance.y * tile.period.y, 0);
      };
      EXPECT_LT(glm::distance(end(yarn.links[i - 1], true), end(yarn.links[i], false)), 1e-15);
    }
  }
}

TEST(Stitch, YarnsWithoutBorderCrossingsInYAreOnePerCourse) {
  const Pattern tile = two_row_tile();
  const std::vector<YarnChain> yarns = stitch(tile, match_partners(tile), {{0, 0}, {7, 4}, {0, 0}});
  ASSERT_EQ(yarns.size(), 8u);
  for (const YarnChain& yarn : yarns) {
    EXPECT_EQ(yarn.links.size(), 7u);
    EXPECT_EQ(yarn.links[0].instance.x, 0);
  }
}

TEST(Stitch, TubeClosesEveryCourse) {
  const Pattern tile = recut(two_row_tile(), {0.0003, 0.0});
  const InstanceRect rect{{2, 0}, {9, 4}, {7, 0}};
  const std::vector<YarnChain> yarns = stitch(tile, match_partners(tile), rect);
  expect_partition(tile, rect, yarns);
  size_t closed = 0;
  for (const YarnChain& yarn : yarns) {
    if (!yarn.closed) continue;
    ++closed;
    EXPECT_EQ(yarn.shift, ivec2(7, 0));
  }
  EXPECT_GE(closed, 6u);  // courses that hang over the lower or upper border are open
}

TEST(Stitch, DiagonalYarnsOnTubeAndTorus) {
  const Pattern tile = diagonal_and_ring();
  const PartnerMap map = match_partners(tile);
  const auto rings = [](const YarnChain& yarn) { return yarn.closed && yarn.links.size() == 1; };
  for (const InstanceRect& rect : {InstanceRect{{0, 0}, {3, 4}, {3, 0}}, InstanceRect{{0, 0}, {3, 3}, {3, 3}}}) {
    const std::vector<YarnChain> yarns = stitch(tile, map, rect);
    expect_partition(tile, rect, yarns);
    const bool torus = rect.wrap.y > 0;
    size_t lines = 0;
    for (const YarnChain& yarn : yarns) {
      if (rings(yarn)) {
        EXPECT_EQ(yarn.shift, ivec2(0, 0));
        continue;
      }
      ++lines;
      EXPECT_EQ(yarn.closed, torus);
      EXPECT_EQ(yarn.links.size(), torus ? 3u : 4u);
      EXPECT_EQ(yarn.shift, torus ? ivec2(3, 3) : ivec2(0, 0));
    }
    EXPECT_EQ(lines, 3u);
    EXPECT_EQ(yarns.size() - lines, size_t(rect.hi.x * rect.hi.y));
  }
}

TEST(Stitch, EmptyRectangleHasNoYarns) {
  const Pattern tile = two_row_tile();
  EXPECT_TRUE(stitch(tile, match_partners(tile), {{0, 0}, {0, 4}, {0, 0}}).empty());
}

}  // namespace
}  // namespace wale
