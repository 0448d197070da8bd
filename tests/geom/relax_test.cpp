// Knits relaxed from charts: what textile science says of them, as numbers.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <map>

#include "geom/chart/loop_curves.h"
#include "geom/relax/relax_strains.h"
#include "geom/relax/relaxation.h"

namespace wale {
namespace {

struct Tile {
  Knit knit;
  PeriodicYarns yarns;
  Relaxed reached;
  dvec2 stitch() const { return yarns.period / dvec2(knit.wales, knit.rows) / (2 * yarns.radius); }
};

PeriodicYarns start_of(const char* chart, double radius, double loop_length, Knit* knit = nullptr) {
  const Knit made = knit_chart(parse_chart(chart, "test"));
  if (knit) *knit = made;
  LoopSizes sizes;
  sizes.yarn_radius = radius;
  sizes.loop_length = loop_length;
  return loop_curves(made, sizes);
}

const Tile& relaxed(const char* chart) {
  static std::map<std::string, Tile> made;
  const auto [it, fresh] = made.try_emplace(chart);
  if (fresh) {
    it->second.yarns = start_of(chart, 0.5e-3, 13.2, &it->second.knit);
    it->second.reached = relax(it->second.yarns, {});
  }
  return it->second;
}

TEST(Relax, EveryTileTouchesAndIsAtRest) {
  for (const char* chart : {"k", "p\nk", "kp", "k2p2", "kp\npk", "kt\nkk", "ks\nkk", "ks\nsk"}) {
    const Tile& tile = relaxed(chart);
    EXPECT_TRUE(tile.reached.converged) << chart;
    EXPECT_LT(tile.reached.force, RelaxSettings().force_tolerance) << chart;
    EXPECT_LT(tile.reached.period_force, RelaxSettings().force_tolerance) << chart;
    const double d = 2 * tile.yarns.radius, closest = closest_distance(tile.yarns, 2 * d, 2 * d) / d;
    EXPECT_EQ(closest, tile.reached.closest) << chart;
    EXPECT_GE(closest, 0.95) << chart;
    EXPECT_LT(closest, 1.0) << chart;
  }
}

TEST(Relax, RibsContractAcross) {
  const double plain = relaxed("k").stitch().x;
  EXPECT_LT(relaxed("kp").stitch().x, 0.6 * plain);
  EXPECT_LT(relaxed("k2p2").stitch().x, 0.6 * plain);
  EXPECT_GT(relaxed("p\nk").stitch().x, 0.6 * plain) << "garter does not";
}

// Of all points of the yarn in front of the middle, how much runs up (legs) and how much across (heads and feet).
double share_of_legs(const PeriodicYarns& y, double side) {
  double middle = 0, up = 0, across = 0;
  for (const dvec3& p : y.points) middle += p.z / double(y.points.size());
  for (const YarnSegment& s : segments_of(y)) {
    const dvec3 v = y.points[s.b] - y.points[s.a] + dvec3(dvec2(s.shift) * y.period, 0);
    if (side * (y.points[s.a].z + 0.5 * v.z - middle) < 0.3 * 2 * y.radius) continue;
    up += std::abs(v.y), across += std::abs(v.x);
  }
  return up / (up + across);
}

TEST(Relax, StockinetteShowsLegsInFrontAndBumpsBehind) {
  EXPECT_GT(share_of_legs(relaxed("k").yarns, 1), 0.6);
  EXPECT_LT(share_of_legs(relaxed("k").yarns, -1), 0.4);
}

TEST(Relax, GarterIsTheSameFromBothSides) {
  const PeriodicYarns& y = relaxed("p\nk").yarns;
  EXPECT_NEAR(share_of_legs(y, 1), share_of_legs(y, -1), 0.02);
  double top = -1, bottom = 1, mean = 0;
  for (const dvec3& p : y.points) top = std::max(top, p.z), bottom = std::min(bottom, p.z), mean += p.z;
  mean /= double(y.points.size());
  EXPECT_NEAR(top - mean, mean - bottom, 0.05 * 2 * y.radius);
}

TEST(Relax, SizeDoesNotMatter) {
  PeriodicYarns large = start_of("kp", 0.5, 13.2);
  const Relaxed reached = relax(large, {});
  EXPECT_TRUE(reached.converged);
  EXPECT_NEAR(large.period.x / 1e3, relaxed("kp").yarns.period.x, 1e-3 * relaxed("kp").yarns.period.x);
}

TEST(Relax, SameBytesAgain) {
  PeriodicYarns a = start_of("kp\npk", 0.5e-3, 13.2);
  relax(a, {});
  EXPECT_EQ(a.points, relaxed("kp\npk").yarns.points);
  EXPECT_EQ(a.period, relaxed("kp\npk").yarns.period);
}

TEST(Relax, TooShortALoopSaysHowFarItCame) {
  PeriodicYarns y = start_of("k", 0.5e-3, 7);
  const Relaxed reached = relax(y, {});
  EXPECT_FALSE(reached.converged);
  EXPECT_LT(reached.steps, RelaxSettings().max_steps) << "it stands still, and must not go on";
  EXPECT_GT(reached.thickness_share, 0.5);
  EXPECT_LT(reached.thickness_share, 1);
  EXPECT_GT(reached.closest, 0);
  EXPECT_EQ(reached.end, RelaxEnd::jammed);
  for (const dvec3& p : y.points) EXPECT_TRUE(std::isfinite(p.x + p.y + p.z));
}

TEST(Relax, StopsInTimeAndWhenAsked) {
  PeriodicYarns y = start_of("k2p2\nk2p2\np2k2\np2k2", 0.5e-3, 13.2), z = y;
  RelaxSettings settings;
  settings.max_seconds = 0.05;
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(relax(y, settings).end, RelaxEnd::time);
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 2);
  int calls = 0;
  EXPECT_EQ(relax(z, {}, [&](double, double) { return ++calls < 3; }).end, RelaxEnd::stopped);
  EXPECT_EQ(calls, 3);
  settings = {};
  settings.max_steps = 5;
  const Relaxed reached = relax(z, settings);
  EXPECT_EQ(reached.end, RelaxEnd::steps);
  EXPECT_EQ(reached.steps, 5);
}

// A yarn that gives way where the loop should is jammed, and is not relaxed for ever.
TEST(Relax, YarnThatOnlyStretchesIsJammed) {
  RelaxSettings settings;
  settings.most_strain = 0.03;
  PeriodicYarns y = start_of("tt\nkk", 0.5e-3, 13.2), z = start_of("tt\nkk", 0.5e-3, 18);
  const Relaxed reached = relax(y, settings), longer = relax(z, settings);
  EXPECT_EQ(reached.end, RelaxEnd::jammed);
  EXPECT_GT(reached.strain, 0.03);
  EXPECT_LT(reached.steps, 400) << "it was 2000";
  EXPECT_TRUE(longer.converged);
  EXPECT_LT(longer.strain, 0.001);
}

// Whoever stops it does not wait until the yarns have been brought to the next strain.
TEST(RelaxStrains, StopsWhileTheClothIsStrained) {
  constexpr size_t kStretched = 1;  // path of the shape at +400 %
  int rounds = 0;
  RelaxSettings settings;
  settings.watch = [&](size_t path, const PeriodicYarns&) { rounds += path == kStretched; };
  const auto stop_after = [&](int most) {
    rounds = 0;
    return relax_strains(relaxed("k").yarns, settings, {0, 4}, {0}, 1, [&](double) { return rounds < most; }).stopped;
  };
  EXPECT_TRUE(stop_after(3));
  EXPECT_EQ(rounds, 3);
}

TEST(RelaxStrains, LoopsOpenBeforeTheYarnStretches) {
  const PeriodicYarns& y = relaxed("k").yarns;
  const RelaxedStrains one = relax_strains(y, {}, {-0.2, 0, 0.5}, {0, 0.25}, 1);
  const RelaxedStrains two = relax_strains(y, {}, {-0.2, 0, 0.5}, {0, 0.25}, 3);
  EXPECT_TRUE(one.converged());
  EXPECT_EQ(one.table.offsets, two.table.offsets) << "threads";
  for (const dvec3& g : one.table.offsets[1]) EXPECT_EQ(g, dvec3(0.0));
  const auto length = [&](size_t node, double a, double b, bool affine) {
    double sum = 0;
    for (const YarnSegment& s : segments_of(y)) {
      dvec3 v = y.points[s.b] - y.points[s.a] + dvec3(dvec2(s.shift) * y.period, 0);
      if (!affine) v += one.table.offsets[node][s.b] - one.table.offsets[node][s.a];
      sum += glm::length(v * dvec3(1 + a, 1 + b, 1));
    }
    return sum;
  };
  const double rest = length(1, 0, 0, true), grown = length(2, 0.5, 0, false) / rest - 1;
  // MADYPG's table of stockinette with about this loop length: 0.0703, and 0.240 affine (strain_growth_test.cpp).
  EXPECT_NEAR(grown, 0.0703, 0.1 * 0.0703);
  EXPECT_GT(length(2, 0.5, 0, true) / rest - 1, 0.2);
}

}  // namespace
}  // namespace wale
