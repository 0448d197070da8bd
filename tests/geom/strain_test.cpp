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

/// Moves of a relaxed fabric's vertices against the affine one, of one run and ply.
std::vector<dvec3> moves(const Fabric& relaxed, const Fabric& affine, const PlyRun& run, uint32_t ply) {
  std::vector<dvec3> out;
  for (uint32_t k = 0; k < run.count; ++k) {
    const size_t v = run.first_vertex + ply * run.count + k;
    out.push_back(place(relaxed, v) - place(affine, v));
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

TEST(Strain, WithoutJumpsWhereTheStrainChangesFromFaceToFace) {
  const BaseMesh mesh = striped(0.03, 10, [](int c) { return c % 2 ? 0.4 : 0.0; });
  const Fabric relaxed = knit(mesh, LoopStrain::relaxed, kReach, 1), affine = knit(mesh, LoopStrain::affine, kReach, 1);
  double steepest = 0, most = 0;
  for (const PlyRun& run : relaxed.runs) {
    const std::vector<dvec3> move = moves(relaxed, affine, run, 0);
    for (uint32_t k = 0; k + 1 < run.count; ++k) {
      const size_t v = run.first_vertex + k;
      const double step = relaxed.anchors[v + 1].length - relaxed.anchors[v].length;  // rest length
      most = std::max(most, glm::length(move[k]));
      if (step > 0 && step < 0.001) steepest = std::max(steepest, glm::length(move[k + 1] - move[k]) / step);
    }
  }
  EXPECT_GT(most, 0.1 * kReach);
  // |dg/ds| <= strain * |d(offset)/ds| + offset * |d(strain)/ds|, drawn out by at most 1.4; the offset has two periods
  // in a stitch of length L. A jump of the strain would move a yarn by 0.2 kReach within one sample of L / 30.
  const double loop =
      yarn_per_tile(straining_tile(0), match_partners(straining_tile(0)), yarn_spec(straining_tile(0), 1), dvec3(1));
  EXPECT_LT(steepest, 1.4 * kReach * (0.4 * 2 * 2 * std::numbers::pi / loop * 1.5 + 1.5 * 0.4 / 0.003));
}

TEST(Strain, ATubeIsClosedAtItsSeam) {
  // Strained more on one side of the seam (at angle 0) than on the other.
  const int around = 12;
  const double radius = 0.01;
  const auto strained = [&](dvec3 p) {
    double angle = std::atan2(p.y, p.x);
    if (angle < -1e-9) angle += 2 * std::numbers::pi;
    const double r = radius * (1 + 0.3 * angle / (2 * std::numbers::pi));
    return dvec3(r * std::cos(angle), r * std::sin(angle), p.z);
  };
  const BaseMesh mesh = moved(make_tube(radius, 0.012, around, 4), strained);
  const Fabric relaxed = knit(mesh, LoopStrain::relaxed), affine = knit(mesh, LoopStrain::affine);
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
      // Across the seam, where the closed yarn begins and ends, it moves no more from sample to sample than elsewhere.
      const std::vector<dvec3> move = moves(relaxed, affine, run, p);
      double inside = 0;
      for (uint32_t k = 2; k + 3 < run.count; ++k) inside = std::max(inside, glm::length(move[k + 1] - move[k]));
      EXPECT_LE(glm::length(move[1] - move[0]), inside);
      EXPECT_LE(glm::length(move[run.count - 1] - move[run.count - 2]), inside);
    }
  }
  EXPECT_GT(closed, 0u);
}

TEST(Strain, TheSameOnBothSidesOfAJoin) {
  const BaseMesh mesh = moved(make_tube(0.01, 0.012, 12, 4), [](dvec3 p) {
    const bool beside = p.x > 0 && std::abs(p.y) < 0.006;
    return beside ? dvec3(1.3 * p.x, p.y, p.z) : p;
  });
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
      const auto& uv = affine.mesh.uv[b.triangle];
      const double u = (1 - double(b.b1) - b.b2) * uv[0].x + double(b.b1) * uv[1].x + double(b.b2) * uv[2].x;
      if (u > 0.5 * 0.03 + 0.003) {  // a column beyond the fifth, whose left vertices are strained
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
    const Anchor& a = f.anchors[v];
    const auto& uv = f.mesh.uv[a.triangle];
    return dvec3((1 - double(a.b1) - a.b2) * uv[0] + double(a.b1) * uv[1] + double(a.b2) * uv[2], a.height);
  };
  for (const PlyRun& run : relaxed.runs)
    for (uint32_t k = 1; k + 1 < run.count; ++k) {
      const size_t v = run.first_vertex + k, w = v + run.count, u = v - 1;
      const dvec3 across = flat(relaxed, w) - flat(relaxed, v), before = flat(affine, w) - flat(affine, v);
      EXPECT_NEAR(glm::length(across), glm::length(before), 1e-4 * glm::length(before));
      // Square to the yarn as it was, and the frame square to its ply.
      const dvec3 normal(relaxed.anchors[v].nx, relaxed.anchors[v].ny, relaxed.anchors[v].nz);
      const dvec3 edges =
          glm::normalize(flat(relaxed, v) - flat(relaxed, u)) + glm::normalize(flat(relaxed, v + 1) - flat(relaxed, v));
      EXPECT_LT(std::abs(glm::dot(normal, glm::normalize(edges))), 1e-3);
    }
}

TEST(Strain, BeyondTheTableItsBorderIsTakenAndCounted) {
  const BaseMesh far = moved(make_swatch(0.02, 0.012, 6, 4), [](dvec3 p) { return dvec3(1.9 * p.x, p.y, p.z); });
  const Fabric beyond = knit(far, LoopStrain::relaxed, kReach, 1);
  EXPECT_GT(beyond.report.strain.samples, 0u);
  EXPECT_EQ(beyond.report.strain.clamped, beyond.report.strain.samples);
  EXPECT_NEAR(beyond.report.strain.most.x, 0.9, 1e-6);
  const BaseMesh border = moved(make_swatch(0.02, 0.012, 6, 4), [](dvec3 p) { return dvec3(1.5 * p.x, p.y, p.z); });
  const Fabric at_border = knit(border, LoopStrain::relaxed, kReach, 1);
  EXPECT_EQ(at_border.report.strain.clamped, 0u);
  expect_same_bits(beyond, at_border);
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

TEST(Strain, NeedsATableAndStoredPoints) {
  const BaseMesh mesh = make_swatch(0.02, 0.012, 6, 4);
  FabricSpec spec = strained_spec(LoopStrain::relaxed);
  expect_user_error([&] { knit_fabric(mesh, stockinette_pattern(0.002), spec); },
                    {"fabric 'cloth'", "no table of strains", "affine"});
  spec.lattice = 1;
  expect_user_error([&] { knit_lattice(mesh, straining_tile(kReach), spec); }, {"fabric 'cloth'", "relaxed", "stored"});
}

}  // namespace
}  // namespace wale
