// Relaxed loops are what the same tiles were found to be when they were relaxed under strain: published tables.
#include "tests/geom/published_strains.h"

namespace wale {
namespace {

using namespace test;

/// Five of the nine strains: -0.2, 0, 1/6, 0.5, 1.
Pattern with_sparse_table(const PublishedStrains& published) {
  constexpr size_t kKept[] = {0, 2, 3, 5, 8};
  Pattern tile = published.tile;
  for (const size_t i : kKept) tile.strains.course.push_back(published.axis.at(i));
  tile.strains.wale = tile.strains.course;
  for (const size_t iw : kKept)
    for (const size_t ic : kKept) tile.strains.offsets.push_back(published.offsets[iw * published.axis.size() + ic]);
  return tile;
}

class RealStrains : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto found = published_stockinette();
    if (!found) GTEST_SKIP() << "real data not present";
    published_ = *found;
  }

  /// A flat cloth of some tiles, its UVs metres, drawn out along x and y; one ply, so that it is the yarn.
  Fabric knit(const Pattern& tile, dvec2 strain, LoopStrain loops) const {
    const dvec2 size = published_.tile.period * dvec2(5, 6);
    const BaseMesh mesh = moved(make_swatch(size.x, size.y, 8, 8), [&](dvec3 p) { return p * dvec3(1.0 + strain, 1); });
    return knit_fabric(mesh, tile, strained_spec(loops, 1), 1);
  }

  PublishedStrains published_;
};

/// Length of all yarn inside a rectangle of whole tiles in the middle of the cloth.
double length_within(const Fabric& fabric, dvec2 half) {
  double sum = 0;
  for (const PlyRun& run : fabric.runs)
    for (uint32_t k = 0; k + 1 < run.count; ++k) {
      const dvec3 a = place(fabric, run.first_vertex + k), b = place(fabric, run.first_vertex + k + 1);
      const dvec2 middle = glm::abs(dvec2(a + b) / 2.0);
      if (middle.x < half.x && middle.y < half.y) sum += glm::distance(a, b);
    }
  return sum;
}

/// Root mean square and largest distance of a fabric's yarn, in the middle of the cloth, from the published one.
struct Distance {
  double mean = 0, most = 0;  ///< yarn radii
};
Distance distance_from(const Pattern& there, const Fabric& fabric) {
  std::vector<std::pair<dvec3, dvec3>> segments;
  knit_flat(there, match_partners(there), yarn_spec(there, 1), dvec3(1), {{-3, -3}, {4, 4}, {0, 0}},
            [&](FlatYarn&& yarn) {
              for (size_t k = 0; k + 1 < yarn.centre.size(); ++k)
                segments.push_back({yarn.centre[k], yarn.centre[k + 1]});
            });
  const dvec3 corner(there.period * dvec2(0.5, 0), 0);  // the middle of 5 x 6 tiles lies in the middle of one
  Distance out;
  double sum = 0;
  size_t count = 0;
  for (const PlyRun& run : fabric.runs)
    for (uint32_t k = 0; k < run.count; ++k) {
      const dvec3 p = place(fabric, run.first_vertex + k);
      if (std::abs(p.x) > there.period.x || std::abs(p.y) > there.period.y) continue;
      double nearest = INFINITY;
      for (const auto& [a, b] : segments) {
        const dvec3 d = b - a, at = p + corner - a;
        nearest = std::min(nearest, glm::length(at - std::clamp(glm::dot(at, d) / glm::dot(d, d), 0.0, 1.0) * d));
      }
      out.most = std::max(out.most, nearest / there.yarn_radius);
      sum += nearest * nearest;
      ++count;
    }
  EXPECT_GT(count, 100u);
  out.mean = std::sqrt(sum / double(count)) / there.yarn_radius;
  return out;
}

TEST_F(RealStrains, YarnGrowsAsInThePublishedTable) {
  const Pattern tile = with_sparse_table(published_);
  const dvec2 middle = 1.5 * published_.tile.period;  // half of three tiles
  const double unstrained = length_within(knit(tile, {0, 0}, LoopStrain::relaxed), middle);
  for (const double strain : {0.5, 1.0}) {
    const dvec2 half = middle * dvec2(1 + strain, 1);
    const double relaxed = length_within(knit(tile, {strain, 0}, LoopStrain::relaxed), half) / unstrained;
    const double affine = length_within(knit(tile, {strain, 0}, LoopStrain::affine), half) / unstrained;
    const double wanted = yarn_length(strained_tile(published_, {strain, 0})) / yarn_length(published_.tile);
    std::printf("  course-wise %+.0f %%: yarn %.4f relaxed, %.4f affine, %.4f published\n", 100 * strain, relaxed,
                affine, wanted);
    EXPECT_NEAR(relaxed - 1, wanted - 1, 0.02 * (wanted - 1));
    EXPECT_GT(affine - 1, 2 * (wanted - 1));
  }
}

TEST_F(RealStrains, CentrelinesAreThePublishedOnes) {
  const Pattern tile = with_sparse_table(published_);
  for (const dvec2 strain : {dvec2(0.5, 0), dvec2(1, 0), dvec2(0, 1.0 / 6), dvec2(0.5, 0.5)}) {
    const Distance d = distance_from(strained_tile(published_, strain), knit(tile, strain, LoopStrain::relaxed));
    std::printf("  strain %.3f x %.3f: %.4f yarn radii (rms), %.4f at most\n", strain.x, strain.y, d.mean, d.most);
    // Two polylines: 0.05 radii from its curve, drawn out by the strain, and 0.02.
    EXPECT_LT(d.most, 0.05 * (1 + std::max(strain.x, strain.y)) + 0.02);
  }
}

TEST_F(RealStrains, BetweenTheStrainsOfTheTableTheyAreNear) {
  const Pattern tile = with_sparse_table(published_);
  for (const dvec2 strain : {dvec2(1.0 / 3, 0), dvec2(2.0 / 3, 0), dvec2(0, 1.0 / 3), dvec2(2.0 / 3, 2.0 / 3)}) {
    const Pattern there = strained_tile(published_, strain);
    const Distance d = distance_from(there, knit(tile, strain, LoopStrain::relaxed));
    const Distance scaled = distance_from(there, knit(tile, strain, LoopStrain::affine));
    std::printf("  strain %.3f x %.3f: %.3f yarn radii (rms), affine %.3f\n", strain.x, strain.y, d.mean, scaled.mean);
    EXPECT_LT(d.mean, 0.5 * scaled.mean);
  }
}

}  // namespace
}  // namespace wale
