// A chart relaxed beside the tile of the same pattern that Sperl et al. 2020 (MADYPG) simulated, with its yarn and its
// loop length.
#include <gtest/gtest.h>

#include <cstdlib>

#include "geom/chart/knit_tile.h"
#include "geom/relax/periodic_yarns.h"
#include "tests/geom/tile_fixtures.h"
#include "tests/tolerances.h"

namespace wale {
namespace {

// Centrelines of one tile as segments, and the period that repeats them.
struct Centrelines {
  std::vector<std::pair<dvec3, dvec3>> segments;
  dvec2 period{0, 0};
  double length = 0;
};

Centrelines centrelines_of(const Pattern& tile) {
  Centrelines out;
  out.period = tile.period;
  const PartnerMap partners = match_partners(tile);
  for (const YarnChain& yarn : tile_yarns(tile, partners)) {
    std::vector<dvec3> points = test::cycle_points(tile, yarn);
    points.push_back(points.front() + dvec3(dvec2(yarn.shift) * tile.period, 0));
    for (size_t i = 0; i + 1 < points.size(); ++i) {
      out.segments.emplace_back(points[i], points[i + 1]);
      out.length += glm::distance(points[i], points[i + 1]);
    }
  }
  return out;
}

double distance_to(const Centrelines& lines, const dvec3& p) {
  double best = INFINITY;
  for (const auto& [a, b] : lines.segments) {
    const dvec3 middle = 0.5 * (a + b);
    const dvec2 near = glm::round((dvec2(p) - dvec2(middle)) / lines.period);
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y) {
        const dvec3 q = p - dvec3((near + dvec2(x, y)) * lines.period, 0), along = b - a;
        const double t = std::clamp(glm::dot(q - a, along) / glm::dot(along, along), 0.0, 1.0);
        best = std::min(best, glm::distance(q, a + t * along));
      }
  }
  return best;
}

// Largest distance of a point of `one`, moved by `shift`, from the lines of `other`; from `enough` on any such
// distance.
double farthest(const Centrelines& one, const Centrelines& other, const dvec3& shift, double enough) {
  double worst = 0;
  for (const auto& [a, b] : one.segments)
    for (const double t : {0.0, 0.5}) {
      worst = std::max(worst, distance_to(other, glm::mix(a, b, t) + shift));
      if (worst >= enough) return worst;
    }
  return worst;
}

double symmetric(const Centrelines& a, const Centrelines& b, const dvec3& shift, double enough) {
  const double there = farthest(a, b, shift, enough);
  return there >= enough ? there : std::max(there, farthest(b, a, -shift, enough));
}

// Symmetric Hausdorff distance of one tile each, after the best shift and mirroring.
double hausdorff(Centrelines a, const Centrelines& b) {
  double best = INFINITY;
  for (int mirror = 0; mirror < 8; ++mirror) {
    Centrelines m = a;
    const dvec3 sign(mirror & 1 ? -1 : 1, mirror & 2 ? -1 : 1, mirror & 4 ? -1 : 1);
    for (auto& [p, q] : m.segments) p *= sign, q *= sign;
    dvec3 at(0);
    double here = INFINITY;
    constexpr int kGrid = 8;
    for (int i = 0; i < kGrid; ++i)
      for (int j = 0; j < kGrid; ++j) {
        const dvec3 shift(dvec2(i, j) / double(kGrid) * b.period, 0);
        if (const double d = symmetric(m, b, shift, here); d < here) here = d, at = shift;
      }
    // Compass search: the shift across the cloth is found by it too.
    for (double step = b.period.y / kGrid; step > 1e-4 * b.period.y; step *= 0.5)
      for (bool moved = true; moved;) {
        moved = false;
        for (int k = 0; k < 6; ++k) {
          dvec3 next = at;
          next[k / 2] += k % 2 ? step : -step;
          if (const double d = symmetric(m, b, next, here); d < here) here = d, at = next, moved = true;
        }
      }
    best = std::min(best, here);
  }
  return best;
}

struct Published {
  const char *file, *chart;
  double period, distance;  // tolerances: share, yarn radii
  bool takes_minutes = false;
};

class RelaxPublished : public testing::TestWithParam<Published> {};

TEST_P(RelaxPublished, HasTheShapeOfTheSimulatedTile) {
  const char* root = std::getenv("WALE_REAL_DATA");
  if (!root) GTEST_SKIP() << "real data not present";
  const Published& expected = GetParam();
  const char* long_tests = std::getenv("WALE_LONG_TESTS");
  if (expected.takes_minutes && (!long_tests || std::string(long_tests) != "1")) GTEST_SKIP() << "takes minutes";
  const Pattern published =
      read_pattern(std::filesystem::path(root) / "yarn-patterns/madypg" / (std::string(expected.file) + ".pyp"));
  const Centrelines theirs = centrelines_of(published);
  KnitSettings settings;
  settings.yarn_thickness = 2 * published.yarn_radius;
  settings.loop_length = 13 * published.yarn_radius * 2;
  settings.step = 0.45;
  const StitchChart chart = parse_chart(expected.chart, "published.chart");
  // As much yarn as theirs; what a slipped stitch takes is part of it.
  KnittedTile ours;
  for (int round = 0; round < 3; ++round) {
    ours = knit_tile(chart, settings);
    ASSERT_TRUE(ours.relaxed.converged);
    settings.loop_length *= theirs.length / centrelines_of(ours.pattern).length;
  }
  const auto distance = [&](const KnittedTile& tile) {
    return hausdorff(centrelines_of(tile.pattern), theirs) / published.yarn_radius;
  };
  const dvec2 periods = ours.pattern.period / published.period - 1.0;
  settings.period = published.period;
  const KnittedTile held = knit_tile(chart, settings);
  ASSERT_TRUE(held.relaxed.converged);
  const double free_distance = distance(ours), held_distance = distance(held);
  std::printf("  %s: periods %+.2f %%, %+.2f %%; Hausdorff distance %.3f yarn radii, %.3f at the published period\n",
              expected.file, 100 * periods.x, 100 * periods.y, free_distance, held_distance);
  EXPECT_LT(std::abs(periods.x), expected.period);
  EXPECT_LT(std::abs(periods.y), expected.period);
  EXPECT_LT(held_distance, expected.distance);
}

INSTANTIATE_TEST_SUITE_P(
    Madypg, RelaxPublished,
    testing::Values(Published{"stockinette", "k2\nk2\n", tolerance::kPublishedPeriod, tolerance::kPublishedDistance},
                    Published{"cartridge_belt_rib", "p s p2\nk3 S\np s p2\nk3 S\n", tolerance::kPublishedRibPeriod,
                              tolerance::kPublishedRibDistance, true}),
    [](const auto& test) { return std::string(test.param.file); });

}  // namespace
}  // namespace wale
