// Published strain tables (Sperl et al. 2020, MADYPG), read where the environment says they are.
#pragma once
#include <cstdio>
#include <cstring>
#include <iterator>
#include <optional>
#include <sstream>

#include "geom/cycle_samples.h"
#include "tests/geom/strained_fixtures.h"

namespace wale::test {

/// A tile, the shapes that were published for it without shear, and their axis, the same along course and wale.
struct PublishedStrains {
  Pattern tile;
  std::vector<double> axis;
  std::vector<std::vector<dvec3>> offsets;  ///< [iw * axis.size() + ic], as in StrainTable
};

inline std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

inline std::vector<double> numbers(const std::string& line) {
  std::istringstream in(line);
  return {std::istream_iterator<double>(in), {}};
}

/// Vertices of a .pyp file in its own order.
inline std::vector<dvec3> vertices_of(const std::filesystem::path& file) {
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
inline size_t vertex_at(const dvec3& point, const std::vector<dvec3>& vertices, dvec2 period) {
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
inline PublishedStrains read_published(const std::filesystem::path& madypg, const std::string& name,
                                       const std::string& table) {
  PublishedStrains out;
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

inline size_t number_of(const PublishedStrains& published, double strain) {
  size_t i = 0;
  while (std::abs(published.axis.at(i) - strain) > 1e-6) ++i;
  return i;
}

/// The published shape at a strain of the table, as a tile of its own.
inline Pattern strained_tile(const PublishedStrains& published, dvec2 strain) {
  Pattern tile = published.tile;
  const size_t n = published.axis.size();
  const auto& offsets = published.offsets[number_of(published, strain.y) * n + number_of(published, strain.x)];
  size_t point = 0;
  for (PatternCurve& curve : tile.curves)
    for (dvec3& p : curve.points) p = (p + offsets[point++]) * dvec3(1.0 + strain, 1);
  tile.period *= 1.0 + strain;
  return tile;
}

inline double yarn_length(const Pattern& tile) {
  return yarn_per_tile(tile, match_partners(tile), yarn_spec(tile, 1), dvec3(1));
}

/// That of stockinette; nothing where the data is not there.
inline std::optional<PublishedStrains> published_stockinette() {
  const char* root = std::getenv("WALE_REAL_DATA");
  if (!root) return std::nullopt;
  const auto madypg = std::filesystem::path(root) / "yarn-patterns/madypg";
  if (!std::filesystem::exists(madypg / "strain-tables/model_stock_9/data.npy")) return std::nullopt;
  return read_published(madypg, "stockinette", "model_stock_9");
}

}  // namespace wale::test
