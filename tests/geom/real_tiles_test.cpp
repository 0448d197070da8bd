// Relaxed tiles of Sperl et al. 2020 (MADYPG), read where the environment says they are.
#include "tests/geom/tile_fixtures.h"

namespace wale {
namespace {

using namespace test;

struct Expected {
  const char* name;
  double period_x, period_y, radius;  // mm
  size_t vertices, yarns, open_curves, backwards;
  ivec2 stitches;
};

class RealTiles : public ::testing::TestWithParam<Expected> {
 protected:
  void SetUp() override {
    const char* root = std::getenv("WALE_REAL_DATA");
    if (!root) GTEST_SKIP() << "real data not present";
    file_ = std::filesystem::path(root) / "yarn-patterns/madypg" / (std::string(GetParam().name) + ".pyp");
    if (!std::filesystem::exists(file_)) GTEST_SKIP() << "real data not present";
    tile_ = read_pattern(file_);
  }
  std::filesystem::path file_;
  Pattern tile_;
};

TEST_P(RealTiles, MatchesItsPublishedTopology) {
  const Expected& expected = GetParam();
  EXPECT_NEAR(tile_.period.x, expected.period_x * 1e-3, 1e-6);
  EXPECT_NEAR(tile_.period.y, expected.period_y * 1e-3, 1e-6);
  EXPECT_NEAR(tile_.yarn_radius, expected.radius * 1e-3, 2e-6);
  EXPECT_EQ(tile_.curves.size(), expected.open_curves);
  const PartnerMap map = match_partners(tile_);
  expect_involution(tile_, map);
  EXPECT_LT(map.worst_distance, 1e-17);
  const std::vector<YarnChain> yarns = tile_yarns(tile_, map);
  EXPECT_EQ(yarns.size(), expected.yarns);
  size_t vertices = 0, backwards = 0;
  for (const YarnChain& yarn : yarns) {
    vertices += cycle_points(tile_, yarn).size();
    const bool reversed = yarn.links[0].reversed;
    backwards += reversed;
    for (const Link& link : yarn.links) EXPECT_EQ(link.reversed, reversed);
  }
  EXPECT_EQ(vertices, expected.vertices);
  EXPECT_EQ(backwards, expected.backwards);
  EXPECT_EQ(tile_.stitches, expected.stitches);
}

TEST_P(RealTiles, StitchesIntoFullYarns) {
  const PartnerMap map = match_partners(tile_);
  for (const InstanceRect& rect : {InstanceRect{{-1, 2}, {4, 6}, {0, 0}}, InstanceRect{{0, 0}, {4, 3}, {4, 3}}}) {
    const std::vector<YarnChain> yarns = stitch(tile_, map, rect);
    expect_partition(tile_, rect, yarns);
    size_t nodes = 0;
    for (const YarnChain& yarn : yarns) {
      nodes += yarn.links.size();
      EXPECT_EQ(yarn.closed, rect.wrap.x > 0);
    }
    EXPECT_EQ(nodes, tile_.curves.size() * (rect.hi.x - rect.lo.x) * (rect.hi.y - rect.lo.y));
  }
}

TEST_P(RealTiles, SampledYarnsArePeriodic) {
  const YarnSpec spec = yarn_spec(tile_);
  const InstanceRect rect{{0, 0}, {5, 5}, {5, 5}};
  const std::vector<YarnChain> chains = stitch(tile_, match_partners(tile_), rect);
  const std::vector<FlatYarn> yarns = knit_all(tile_, spec, rect);
  ASSERT_EQ(chains.size(), yarns.size());
  for (size_t i = 0; i < yarns.size(); ++i) {
    const FlatYarn& yarn = yarns[i];
    ASSERT_TRUE(yarn.closed);
    const size_t step = (yarn.centre.size() - 3) / 5;
    const dvec3 period(chains[i].shift.x / 5 * tile_.period.x, chains[i].shift.y / 5 * tile_.period.y, 0);
    for (size_t k = 0; k + step < yarn.centre.size(); ++k)
      EXPECT_LT(glm::distance(yarn.centre[k] + period, yarn.centre[k + step]), 1e-12 * glm::length(tile_.period));
  }
}

TEST_P(RealTiles, LeafRoundTrip) {
  ScratchFolder folder;
  tile_.kind = CurveKind::bspline;
  const auto file = folder / fmt::format("{}_{:.17g}.txt", tile_.name, tile_.yarn_radius / 1e-3);
  write_pattern_leaf(tile_, file);
  const Pattern back = read_pattern(file);
  EXPECT_NEAR(back.period.x / tile_.period.x, 1, 1e-9);
  EXPECT_NEAR(back.period.y / tile_.period.y, 1, 1e-9);
  EXPECT_EQ(back.stitches, tile_.stitches);
  ASSERT_EQ(back.curves.size(), tile_.curves.size());
  const auto a = tile_yarns(tile_, match_partners(tile_)), b = tile_yarns(back, match_partners(back));
  ASSERT_EQ(a.size(), b.size());
  for (size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].shift, b[i].shift);
    EXPECT_EQ(a[i].links.size(), b[i].links.size());
  }
}

INSTANTIATE_TEST_SUITE_P(Madypg, RealTiles,
                         ::testing::Values(Expected{"stockinette", 15.051, 7.931, 1, 100, 2, 6, 0, {2, 2}},
                                           Expected{"stockinette_small", 1.476, 0.924, 0.1, 100, 2, 6, 0, {2, 2}},
                                           Expected{"cartridge_belt_rib", 17.426, 11.661, 1.001, 356, 4, 12, 1, {3, 4}},
                                           Expected{"stocktiny", 1.44, 0.88, 0.2, 13, 1, 3, 0, {1, 1}},
                                           Expected{"stocktiniest", 0.72, 0.44, 0.1, 13, 1, 3, 0, {1, 1}},
                                           Expected{"basket", 10.704, 10.300, 1, 80, 8, 8, 0, {4, 4}},
                                           Expected{"satin", 11.111, 11.019, 1, 130, 10, 10, 0, {5, 5}}),
                         [](const auto& tile) { return std::string(tile.param.name); });

}  // namespace
}  // namespace wale
