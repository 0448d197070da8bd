// Loops that follow the strain of the cloth: nothing moves where nothing is strained, nothing tears where it is, and a
// point's place on its yarn stays.
#include "tests/geom/strained_fixtures.h"

namespace wale {
namespace {

using namespace test;

constexpr double kReach = 0.0004;  // metres per unit of strain

Fabric knit(const BaseMesh& mesh, LoopStrain strain, double reach = kReach, int plies = 3) {
  return knit_fabric(mesh, straining_tile(reach), strained_spec(strain, plies), 1);
}

/// A flat cloth strained along x by `strain` at the column of vertices that x lies in, `columns` over `width`.
BaseMesh striped(double width, int columns, const std::function<double(int)>& strain) {
  std::vector<double> until(size_t(columns) + 1, 0.0);
  for (int c = 0; c < columns; ++c) until[size_t(c) + 1] = until[size_t(c)] + width / columns * (1 + strain(c));
  return moved(make_swatch(width, 0.012, columns, 4),
               [&](dvec3 p) { return dvec3(until[size_t(std::lround((p.x / width + 0.5) * columns))], p.y, p.z); });
}

/// Moves of a relaxed fabric's vertices on the flat knit (UVs are metres) against the affine one, of one run of one
/// ply.
std::vector<dvec3> moves(const Fabric& relaxed, const Fabric& affine, const PlyRun& run) {
  std::vector<dvec3> out;
  dvec2 join(0);
  for (const dvec2 one : affine.charts[run.chart].joins) join += one;
  for (uint32_t k = 0; k < run.count; ++k) {
    const size_t v = run.first_vertex + k;
    dvec2 uv = uv_of(relaxed, v) - uv_of(affine, v);
    for (const int axis : {0, 1})  // each on its own side of a join
      if (join[axis] > 0) uv[axis] -= join[axis] * std::round(uv[axis] / join[axis]);
    out.push_back(dvec3(uv, relaxed.anchors[v].height - affine.anchors[v].height));
  }
  return out;
}

TEST(Strain, AClothThatIsNotStrainedKeepsItsBits) {
  const BaseMesh flat = make_swatch(0.02, 0.012, 7, 5);
  expect_same_bits(knit(flat, LoopStrain::relaxed), knit(flat, LoopStrain::affine));
  // Turned in space its edges are rounded.
  const double c = std::cos(0.7), s = std::sin(0.7);
  const BaseMesh turned =
      moved(flat, [&](dvec3 p) { return dvec3(c * p.x - s * p.y, s * p.x + c * p.y, 0) + dvec3(0.3, 1, 2); });
  expect_same_bits(knit(turned, LoopStrain::relaxed), knit(turned, LoopStrain::affine));
}

TEST(Strain, ATableOfZerosKeepsEveryBit) {
  const BaseMesh mesh = striped(0.03, 10, [](int c) { return 0.05 * c; });
  const Fabric relaxed = knit(mesh, LoopStrain::relaxed, 0), affine = knit(mesh, LoopStrain::affine, 0);
  EXPECT_GT(relaxed.report.strain.most.x, 0.4);
  expect_same_bits(relaxed, affine);
}

TEST(Strain, AStrainedClothTakesTheShapeOfTheTable) {
  // At +50 % along courses and +20 % along wales, half way between two rows of the table.
  const BaseMesh mesh = moved(make_swatch(0.02, 0.012, 6, 4), [](dvec3 p) { return dvec3(1.5 * p.x, 1.2 * p.y, p.z); });
  const Fabric relaxed = knit(mesh, LoopStrain::relaxed, kReach, 1);
  EXPECT_EQ(relaxed.report.strain.least, dvec2(0.5, relaxed.report.strain.least.y));
  EXPECT_EQ(relaxed.report.strain.most.x, 0.5);
  EXPECT_NEAR(relaxed.report.strain.most.y, 0.2, 1e-6);
  EXPECT_EQ(relaxed.report.strain.clamped, 0u);

  // The tile with its points moved as the table says, knitted affinely, passes through the same places.
  Pattern shape = straining_tile(kReach);
  const auto &low = shape.strains.offsets[3 + 2], &high = shape.strains.offsets[6 + 2];
  size_t point = 0;
  for (PatternCurve& curve : shape.curves)
    for (dvec3& p : curve.points) p += 0.5 * (low[point] + high[point]), ++point;
  const Fabric direct = knit_fabric(mesh, shape, strained_spec(LoopStrain::affine, 1), 1);
  std::vector<dvec3> line;
  std::vector<std::pair<dvec3, dvec3>> segments;
  for (const PlyRun& run : direct.runs)
    for (uint32_t k = 0; k + 1 < run.count; ++k)
      segments.push_back({place(direct, run.first_vertex + k), place(direct, run.first_vertex + k + 1)});
  double farthest = 0;
  for (const PlyRun& run : relaxed.runs)
    for (uint32_t k = 0; k < run.count; ++k) {
      const dvec3 p = place(relaxed, run.first_vertex + k);
      if (std::abs(p.x) > 0.012 || std::abs(p.y) > 0.005) continue;  // near the border, yarns end elsewhere
      double nearest = INFINITY;
      for (const auto& [a, b] : segments) {
        const dvec3 d = b - a;
        const double t = std::clamp(glm::dot(p - a, d) / glm::dot(d, d), 0.0, 1.0);
        nearest = std::min(nearest, glm::length(p - a - t * d));
      }
      farthest = std::max(farthest, nearest);
    }
  // Both are polylines within a tolerance of 0.05 ply radii, drawn out by 1.5, of splines through the same points.
  EXPECT_LT(farthest, 2 * 1.5 * 0.05 * relaxed.ply_radius);
}

/// Largest difference of the moves of two neighbouring samples, metres, ghosts of closed yarns included; without the
/// border, which is extrapolated from one triangle or the other.
double largest_step(const BaseMesh& mesh, double tolerance) {
  const Pattern tile = straining_tile(kReach);
  FabricSpec relaxed = strained_spec(LoopStrain::relaxed, 1), affine = strained_spec(LoopStrain::affine, 1);
  relaxed.tolerance = affine.tolerance = tolerance;
  const Fabric with = knit_fabric(mesh, tile, relaxed, 1), without = knit_fabric(mesh, tile, affine, 1);
  double largest = 0;
  for (const PlyRun& run : with.runs) {
    const std::vector<dvec3> move = moves(with, without, run);
    const auto inside = [&](uint32_t k) {
      const Chart& chart = without.charts[run.chart];
      const dvec2 uv = uv_of(without, run.first_vertex + k), margin = 0.001 * dvec2(chart.joins.empty(), 1);
      return glm::all(glm::greaterThanEqual(uv, chart.uv_min + margin)) &&
             glm::all(glm::lessThanEqual(uv, chart.uv_max - margin));
    };
    for (uint32_t k = 0; k + 1 < run.count; ++k)
      if (inside(k) && inside(k + 1)) largest = std::max(largest, glm::length(move[k + 1] - move[k]));
  }
  return largest;
}

/// A hundred times the tolerance asks for a tenth of the samples: steps of a continuous move shrink with them, a jump
/// stays. (Ten times less, but for the whole number of samples in a tile.)
void expect_no_jump(const BaseMesh& mesh) {
  const double coarse = largest_step(mesh, 0.05), fine = largest_step(mesh, 0.0005);
  EXPECT_GT(coarse, 0.02 * kReach);
  EXPECT_LT(fine, coarse / 7);
}

/// A tube that widens round its girth, and ends at its seam (at angle 0) in a step.
BaseMesh snail() {
  const double radius = 0.01;
  return moved(make_tube(radius, 0.012, 24, 4), [&](dvec3 p) {
    double angle = std::atan2(p.y, p.x);
    if (angle < -1e-9) angle += 2 * std::numbers::pi;
    const double r = radius * (1 + 0.1 * angle / (2 * std::numbers::pi));
    return dvec3(r * std::cos(angle), r * std::sin(angle), p.z);
  });
}

TEST(Strain, WithoutJumpsWhereTheStrainChangesFromFaceToFace) {
  expect_no_jump(striped(0.03, 10, [](int c) { return c % 2 ? 0.4 : 0.0; }));
}

TEST(Strain, WithoutJumpsAcrossTheSeamOfATube) { expect_no_jump(snail()); }

TEST(Strain, ATubeIsClosedAtItsSeam) {
  const Fabric relaxed = knit(snail(), LoopStrain::relaxed);
  size_t closed = 0;
  for (const PlyRun& run : relaxed.runs) {
    if (!run.ghost_ends) continue;
    ++closed;
    for (uint32_t p = 0; p < run.plies; ++p) {
      const size_t first = run.first_vertex + p * run.count, last = first + run.count - 1;
      for (const auto& [ghost, own] : {std::pair{first, last - 2}, {last - 1, first + 1}, {last, first + 2}}) {
        const Anchor &a = relaxed.anchors[ghost], &b = relaxed.anchors[own];
        EXPECT_TRUE(a.triangle == b.triangle && a.b1 == b.b1 && a.b2 == b.b2 && a.height == b.height && a.nx == b.nx &&
                    a.ny == b.ny && a.nz == b.nz);
      }
      // The frame where the yarn begins and ends is square to the edges on both sides.
      const double girth = relaxed.charts[0].joins.at(0).x;
      const auto edge = [&](size_t v) {
        dvec2 uv = uv_of(relaxed, v + 1) - uv_of(relaxed, v);
        uv.x -= girth * std::round(uv.x / girth);
        return glm::normalize(dvec3(uv, relaxed.anchors[v + 1].height - relaxed.anchors[v].height));
      };
      for (const size_t v : {first + 1, last - 1}) {
        const Anchor& a = relaxed.anchors[v];
        EXPECT_LT(std::abs(glm::dot(dvec3(a.nx, a.ny, a.nz), glm::normalize(edge(v - 1) + edge(v)))), 1e-3);
      }
    }
  }
  EXPECT_GT(closed, 0u);
}

TEST(Strain, TheSameOnBothSidesOfAJoin) {
  const BaseMesh mesh = snail();
  const Chart chart = find_charts(mesh).at(0);
  ASSERT_EQ(chart.joins.size(), 1u);
  const StrainField field(mesh, chart, dvec2(1));
  const ChartLocator locator(mesh, chart);
  for (const double v : {0.001, 0.004, 0.0113}) {
    ChartPoint left, right;
    ASSERT_TRUE(locator.locate({chart.uv_min.x + 1e-12, v}, 0, dvec2(1), left));
    ASSERT_TRUE(locator.locate({chart.uv_max.x - 1e-12, v}, 0, dvec2(1), right));
    ASSERT_NE(left.triangle, right.triangle);
    EXPECT_LT(glm::length(field.at(left) - field.at(right)), 1e-8);
    EXPECT_GT(glm::length(field.at(left)), 0.01);
  }
}

TEST(Strain, ASeamOfTwoChartsDoesNotMixThem) {
  // One side of the pillow is drawn out, the other is not.
  BaseMesh mesh = make_pillow(0.02, 0.02, 0.004, 8, 8);
  const std::vector<Chart> charts = find_charts(mesh);
  ASSERT_EQ(charts.size(), 2u);
  for (const uint32_t t : charts[1].triangles)
    for (dvec2& uv : mesh.uv[t]) uv *= 0.5;
  const StrainField front(mesh, charts[0], dvec2(1)), back(mesh, find_charts(mesh)[1], dvec2(1));
  for (const uint32_t t : charts[0].triangles) EXPECT_LT(front.at({t, 0.3, 0.3, 0}).x, 0.5);
  for (const uint32_t t : charts[1].triangles) EXPECT_GT(back.at({t, 0.3, 0.3, 0}).x, 0.5);
}

TEST(Strain, LengthsStayAndOtherPlacesDoNotFeelIt) {
  // Strained on the left alone; vertices on the right, and rest lengths everywhere, keep their bits.
  const BaseMesh mesh = striped(0.03, 10, [](int c) { return c < 4 ? 0.4 : 0.0; });
  const Fabric relaxed = knit(mesh, LoopStrain::relaxed), affine = knit(mesh, LoopStrain::affine);
  ASSERT_EQ(relaxed.anchors.size(), affine.anchors.size());
  size_t left = 0, right = 0;
  for (const PlyRun& run : relaxed.runs)
    for (uint32_t i = 0; i < run.count * run.plies; ++i) {
      const Anchor &a = relaxed.anchors[run.first_vertex + i], &b = affine.anchors[run.first_vertex + i];
      ASSERT_EQ(a.length, b.length);
      if (uv_of(affine, run.first_vertex + i).x >
          0.5 * 0.03 + 0.003) {  // a column beyond the fifth, whose left vertices are strained
        EXPECT_TRUE(same_bits(a, b));
        ++right;
      } else {
        left += !same_bits(a, b);
      }
    }
  EXPECT_GT(left, 100u);
  EXPECT_GT(right, 100u);
}

TEST(Strain, APlyTurnsWithItsYarnAndStaysAtItsDistance) {
  const BaseMesh mesh = striped(0.03, 10, [](int) { return 0.4; });
  const Fabric relaxed = knit(mesh, LoopStrain::relaxed, kReach, 2), affine = knit(mesh, LoopStrain::affine, kReach, 2);
  const auto flat = [](const Fabric& f, size_t v) {  // of the flat knit: x, y, z
    return dvec3(uv_of(f, v), f.anchors[v].height);
  };
  const auto normal_of = [](const Fabric& f, size_t v) {
    return dvec3(f.anchors[v].nx, f.anchors[v].ny, f.anchors[v].nz);
  };
  double turned = 0, moved_axis = 0;
  size_t count = 0;
  for (const PlyRun& run : relaxed.runs)
    for (uint32_t k = 1; k + 1 < run.count; ++k) {
      const size_t v = run.first_vertex + k, w = v + run.count, u = v - 1;
      const dvec3 across = flat(relaxed, w) - flat(relaxed, v), before = flat(affine, w) - flat(affine, v);
      EXPECT_NEAR(glm::length(across), glm::length(before), 1e-4 * glm::length(before));
      // The frame stands to the other ply as it did, but for the squaring to its own ply, which is bent otherwise now.
      const dvec3 normal = normal_of(relaxed, v);
      const double angle = std::acos(std::clamp(glm::dot(normal, glm::normalize(across)), -1.0, 1.0));
      const double angle_before =
          std::acos(std::clamp(glm::dot(normal_of(affine, v), glm::normalize(before)), -1.0, 1.0));
      turned += std::abs(angle - angle_before);
      moved_axis += glm::length(glm::cross(glm::normalize(across), glm::normalize(before)));
      ++count;
      const dvec3 edges =
          glm::normalize(flat(relaxed, v) - flat(relaxed, u)) + glm::normalize(flat(relaxed, v + 1) - flat(relaxed, v));
      EXPECT_LT(std::abs(glm::dot(normal, glm::normalize(edges))), 1e-3);
    }
  EXPECT_GT(moved_axis / double(count), 0.05);
  EXPECT_LT(turned / double(count), 0.002);
}

TEST(Strain, TheSameOnAnyNumberOfThreads) {
  const BaseMesh mesh = striped(0.03, 10, [](int c) { return 0.04 * c; });
  const Pattern tile = straining_tile(kReach);
  const FabricSpec spec = strained_spec(LoopStrain::relaxed);
  const Fabric one = knit_fabric(mesh, tile, spec, 1), four = knit_fabric(mesh, tile, spec, 4);
  expect_same_bits(one, four);
  EXPECT_EQ(one.report.strain.samples, four.report.strain.samples);
  EXPECT_EQ(one.report.strain.most, four.report.strain.most);
}

}  // namespace
}  // namespace wale
