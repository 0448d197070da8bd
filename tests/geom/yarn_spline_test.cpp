#include "geom/yarn_spline.h"

#include "geom/double_reflection.h"
#include "tests/geom/tile_fixtures.h"

namespace wale {
namespace {

using namespace test;

YarnSpline spline_of(const Pattern& pattern, dvec3 scale = dvec3(1)) {
  return YarnSpline(pattern, tile_yarns(pattern, match_partners(pattern))[0], scale);
}

/// Second derivative by the first one at three points of the span: exact for a cubic.
dvec3 second(const YarnSpline& s, int span, double u) {
  return u < 0.5 ? -3.0 * s.derivative(span, 0) + 4.0 * s.derivative(span, 0.5) - s.derivative(span, 1)
                 : s.derivative(span, 0) - 4.0 * s.derivative(span, 0.5) + 3.0 * s.derivative(span, 1);
}

TEST(YarnSpline, InterpolatesEveryPointAndIsSmoothRoundTheCycle) {
  const Pattern tile = recut(stockinette_pattern(), {0.0003, 0.0004});
  const YarnChain cycle = tile_yarns(tile, match_partners(tile))[0];
  const YarnSpline spline(tile, cycle, dvec3(1));
  const std::vector<dvec3> points = cycle_points(tile, cycle);
  ASSERT_EQ(size_t(spline.spans()), points.size());
  for (int i = 0; i < spline.spans(); ++i) {
    EXPECT_LT(glm::distance(spline.position(i, 0), points[i]), 1e-15);
    const int next = (i + 1) % spline.spans();
    const dvec3 wrap = next == 0 ? spline.advance() : dvec3(0);
    EXPECT_LT(glm::distance(spline.position(i, 1), spline.position(next, 0) + wrap), 1e-15);
    // Derivatives in chord length h agree: h follows from the chord.
    const auto chord = [&](int j) { return glm::distance(spline.position(j, 0), spline.position(j, 1)); };
    const dvec3 d0 = spline.derivative(i, 1) / chord(i), d1 = spline.derivative(next, 0) / chord(next);
    EXPECT_LT(glm::distance(d0, d1), 1e-9);
    const dvec3 s0 = second(spline, i, 1) / (chord(i) * chord(i));
    const dvec3 s1 = second(spline, next, 0) / (chord(next) * chord(next));
    EXPECT_LT(glm::distance(s0, s1), 1e-6 * glm::length(s0) + 1e-3);
  }
}

TEST(YarnSpline, BsplineIsC2AcrossJoints) {
  Pattern tile = recut(stockinette_pattern(), {0.0003, 0.0004});
  tile.kind = CurveKind::bspline;
  const YarnSpline spline = spline_of(tile);
  for (int i = 0; i < spline.spans(); ++i) {
    const int next = (i + 1) % spline.spans();
    const dvec3 wrap = next == 0 ? spline.advance() : dvec3(0);
    EXPECT_LT(glm::distance(spline.position(i, 1), spline.position(next, 0) + wrap), 1e-15);
    EXPECT_LT(glm::distance(spline.derivative(i, 1), spline.derivative(next, 0)), 1e-15);
    EXPECT_LT(glm::distance(second(spline, i, 1), second(spline, next, 0)), 1e-14);
  }
}

TEST(YarnSpline, CutsDoNotChangeTheCurve) {
  // The same cycle cut elsewhere gives the same curve: joints leave no trace.
  for (const CurveKind kind : {CurveKind::interpolating, CurveKind::bspline}) {
    Pattern whole = stockinette_pattern();
    whole.kind = kind;
    const Pattern cut = recut(whole, {0, 0.0003});
    ASSERT_GT(cut.curves.size(), 1u);
    EXPECT_NEAR(ArcLength(spline_of(whole)).total() / ArcLength(spline_of(cut)).total(), 1, 1e-12);
  }
}

TEST(YarnSpline, ScaleActsOnTheCurve) {
  const Pattern tile = stockinette_pattern();
  const dvec3 scale(1.3, 0.8, 2);
  const YarnSpline a = spline_of(tile), b = spline_of(tile, scale);
  for (int i = 0; i < a.spans(); ++i) EXPECT_LT(glm::distance(scale * a.position(i, 0.3), b.position(i, 0.3)), 1e-16);
}

TEST(YarnSpline, FewPoints) {
  // Straight yarns of one and two points per cycle, and a point listed twice.
  Pattern tile;
  tile.period = {0.01, 0.01};
  tile.yarn_radius = 0.001;
  const std::vector<std::vector<dvec3>> lines = {{{0, 0, 0}, {0.01, 0, 0}},
                                                 {{0, 0, 0}, {0.004, 0, 0}, {0.01, 0, 0}},
                                                 {{0, 0, 0}, {0.004, 0, 0}, {0.004, 0, 0}, {0.01, 0, 0}}};
  for (const auto& line : lines)
    for (const CurveKind kind : {CurveKind::interpolating, CurveKind::bspline}) {
      tile.kind = kind;
      tile.curves = {{line, false}};
      const YarnSpline spline = spline_of(tile);
      const ArcLength arc(spline);
      EXPECT_NEAR(arc.total(), 0.01, 1e-9);
      for (int i = 0; i < spline.spans(); ++i) EXPECT_NEAR(glm::length(dvec2(spline.position(i, 0.7).y, 0)), 0, 1e-15);
    }
}

TEST(ArcLength, CircleAndInverse) {
  Pattern tile = diagonal_and_ring();
  tile.curves.erase(tile.curves.begin());
  tile.curves[0].points.clear();
  constexpr int kPoints = 200;
  for (int i = 0; i < kPoints; ++i)
    tile.curves[0].points.push_back(
        {0.003 * std::cos(2 * M_PI * i / kPoints), 0.003 * std::sin(2 * M_PI * i / kPoints), 0});
  const YarnSpline spline = spline_of(tile);
  const ArcLength arc(spline);
  EXPECT_NEAR(arc.total() / (2 * M_PI * 0.003), 1, 1e-8);
  for (int i = 0; i <= 37; ++i) {
    const double s = arc.total() * i / 37;
    const ArcLength::Place at = arc.at(s);
    const dvec3 p = spline.position(at.span, at.u);
    const double angle = s / 0.003;
    EXPECT_LT(glm::distance(p, dvec3(0.003 * std::cos(angle), 0.003 * std::sin(angle), 0)), 1e-9);
  }
}

TEST(DoubleReflection, HelixFrameTurnsByTheTorsion) {
  // Against the Frenet frame, the least-rotation frame turns by -(integral of the torsion).
  const double r = 1, c = 0.4, w = std::sqrt(r * r + c * c), torsion = c / (w * w);
  const auto x = [&](double t) { return dvec3(r * std::cos(t), r * std::sin(t), c * t); };
  const auto tangent = [&](double t) { return dvec3(-r * std::sin(t), r * std::cos(t), c) / w; };
  const auto frenet = [&](double t) { return dvec3(-std::cos(t), -std::sin(t), 0); };
  double previous = 0;
  for (const int steps : {64, 128}) {
    const double end = 5, h = end / steps;
    dvec3 n = frenet(0);
    for (int i = 0; i < steps; ++i)
      n = double_reflection(n, x(i * h), tangent(i * h), x((i + 1) * h), tangent((i + 1) * h));
    EXPECT_NEAR(glm::dot(n, tangent(end)), 0, 1e-14);
    EXPECT_NEAR(glm::length(n), 1, 1e-14);
    const dvec3 b = glm::cross(tangent(end), frenet(end));
    const double error = std::abs(std::atan2(glm::dot(n, b), glm::dot(n, frenet(end))) + torsion * w * end);
    EXPECT_LT(error, 1e-5);
    if (previous > 0) {
      EXPECT_LT(error, previous / 12);  // fourth order
    }
    previous = error;
  }
}

TEST(Stockinette, RowsTouchAndNothingInterpenetrates) {
  const double width = 0.0025;
  const Pattern tile = stockinette_pattern(width);
  EXPECT_DOUBLE_EQ(tile.period.x, width);
  EXPECT_EQ(tile.stitches, ivec2(1, 1));
  const double scale = width / (2 * M_PI);
  const auto loop = [&](double t) {
    return scale * dvec3(t + 1.5 * std::sin(2 * t), 3 * std::cos(t), -1.1 * std::cos(2 * t));
  };
  const YarnSpline spline = spline_of(tile);
  double rows = 1, own = 1;
  const int n = 700;
  for (int i = 0; i < n; ++i)
    for (int j = -n; j < 2 * n; ++j) {
      const double s = 2 * M_PI * i / n, t = 2 * M_PI * j / n;
      rows = std::min(rows, glm::distance(loop(s), loop(t) + dvec3(0, tile.period.y, 0)));
      if (std::abs(s - t) > 1.5) own = std::min(own, glm::distance(loop(s), loop(t)));
    }
  EXPECT_NEAR(std::min(rows, own) / (2 * tile.yarn_radius), 1, 1e-4);
  double worst = 0;
  for (int i = 0; i < spline.spans(); ++i) {
    const double t = 2 * M_PI * (i + 0.5) / spline.spans() - M_PI;
    double nearest = 1;
    for (int j = -100; j <= 100; ++j)
      nearest = std::min(nearest, glm::distance(spline.position(i, 0.5), loop(t + j * 1e-5)));
    worst = std::max(worst, nearest);
  }
  EXPECT_LT(worst, 1e-4 * tile.yarn_radius);
  expect_user_error([] { stockinette_pattern(0); }, {"must be positive"});
}

}  // namespace
}  // namespace wale
