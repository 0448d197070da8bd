// Published strain tables (Sperl et al. 2020, MADYPG), read where the environment says they are: relaxed loops are what
// the same tiles were found to be when they were relaxed under strain.
#include <cstdio>
#include <cstring>
#include <iterator>
#include <sstream>

#include "geom/cycle_samples.h"
#include "tests/geom/strained_fixtures.h"

namespace wale {
namespace {

using namespace test;

/// A tile, the shapes that were published for it without shear, and their axis, the same along course and wale.
struct Published {
  Pattern tile;
  std::vector<double> axis;
  std::vector<std::vector<dvec3>> offsets;  ///< [iw * axis.size() + ic], as in StrainTable
};

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<double> numbers(const std::string& line) {
  std::istringstream in(line);
  return {std::istream_iterator<double>(in), {}};
}

/// Vertices of a .pyp file in its own order.
std::vector<dvec3> vertices_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::vector<dvec3> out;
  std::string line;
  while (std::getline(in, line) && line.rfind("*Q", 0) != 0) {
  }
  while (std::getline(in, line)) {
    if (line[0] == '#') continue;
    const std::vector<double> row = numbers(line);
    if (row.size() < 3) break;
    out.emplace_back(row[0], row[1], row[2]);
  }
  return out;
}

/// Number of the vertex in whose place, but for whole periods, a point lies.
size_t vertex_at(const dvec3& point, const std::vector<dvec3>& vertices, dvec2 period) {
  size_t best = 0;
  double nearest = INFINITY;
  for (size_t v = 0; v < vertices.size(); ++v) {
    dvec3 d = point - vertices[v];
    for (const int axis : {0, 1}) d[axis] -= std::round(d[axis] / period[axis]) * period[axis];
    if (glm::length(d) < nearest) nearest = glm::length(d), best = v;
  }
  EXPECT_LT(nearest, 1e-9);
  return best;
}

/// data.npy: float32, row = course + n (shear + n (wale + n vertex)), columns x, y, z and twist.
Published read_published(const std::filesystem::path& madypg, const std::string& name, const std::string& table) {
  Published out;
  out.tile = read_pattern(madypg / (name + ".pyp"));
  const auto folder = madypg / "strain-tables" / table;
  std::istringstream axes(bytes_of(folder / "axes.txt"));
  std::string course, shear, wale;
  std::getline(axes, course), std::getline(axes, shear), std::getline(axes, wale);
  EXPECT_EQ(course, wale);
  out.axis = numbers(course);
  const size_t n = out.axis.size(), straight = numbers(shear).size() / 2;
  EXPECT_EQ(numbers(shear).at(straight), 0);

  const std::string data = bytes_of(folder / "data.npy");
  const size_t begin = 10 + size_t(uint8_t(data.at(8))) + 256 * size_t(uint8_t(data.at(9)));
  const std::vector<dvec3> vertices = vertices_of(madypg / (name + ".pyp"));
  EXPECT_EQ(data.size() - begin, vertices.size() * n * n * numbers(shear).size() * 4 * sizeof(float));
  std::vector<size_t> numbered;
  for (const PatternCurve& curve : out.tile.curves)
    for (const dvec3& p : curve.points) numbered.push_back(vertex_at(p, vertices, out.tile.period));
  for (size_t iw = 0; iw < n; ++iw)
    for (size_t ic = 0; ic < n; ++ic) {
      auto& shape = out.offsets.emplace_back();
      for (const size_t v : numbered) {
        float g[3];
        std::memcpy(g, data.data() + begin + (ic + n * (straight + n * (iw + n * v))) * 4 * sizeof(float), sizeof g);
        shape.emplace_back(g[0], g[1], g[2]);
      }
    }
  return out;
}

/// Five of the nine strains: -0.2, 0, 1/6, 0.5, 1.
Pattern with_sparse_table(const Published& published) {
  constexpr size_t kKept[] = {0, 2, 3, 5, 8};
  Pattern tile = published.tile;
  for (const size_t i : kKept) tile.strains.course.push_back(published.axis.at(i));
  tile.strains.wale = tile.strains.course;
  for (const size_t iw : kKept)
    for (const size_t ic : kKept) tile.strains.offsets.push_back(published.offsets[iw * published.axis.size() + ic]);
  return tile;
}

size_t number_of(const Published& published, double strain) {
  size_t i = 0;
  while (std::abs(published.axis.at(i) - strain) > 1e-6) ++i;
  return i;
}

/// The published shape at a strain of the table, as a tile of its own.
Pattern strained_tile(const Published& published, dvec2 strain) {
  Pattern tile = published.tile;
  const size_t n = published.axis.size();
  const auto& offsets = published.offsets[number_of(published, strain.y) * n + number_of(published, strain.x)];
  size_t point = 0;
  for (PatternCurve& curve : tile.curves)
    for (dvec3& p : curve.points) p = (p + offsets[point++]) * dvec3(1.0 + strain, 1);
  tile.period *= 1.0 + strain;
  return tile;
}

double yarn_length(const Pattern& tile) {
  return yarn_per_tile(tile, match_partners(tile), yarn_spec(tile, 1), dvec3(1));
}

class RealStrains : public ::testing::Test {
 protected:
  void SetUp() override {
    const char* root = std::getenv("WALE_REAL_DATA");
    if (!root) GTEST_SKIP() << "real data not present";
    const auto madypg = std::filesystem::path(root) / "yarn-patterns/madypg";
    if (!std::filesystem::exists(madypg / "strain-tables/model_stock_9/data.npy"))
      GTEST_SKIP() << "real data not present";
    published_ = read_published(madypg, "stockinette", "model_stock_9");
  }

  /// A flat cloth of some tiles, its UVs metres, drawn out along x and y; one ply, so that it is the yarn.
  Fabric knit(const Pattern& tile, dvec2 strain, LoopStrain loops) const {
    const dvec2 size = published_.tile.period * dvec2(5, 6);
    const BaseMesh mesh = moved(make_swatch(size.x, size.y, 8, 8), [&](dvec3 p) { return p * dvec3(1.0 + strain, 1); });
    return knit_fabric(mesh, tile, strained_spec(loops, 1), 1);
  }

  Published published_;
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
