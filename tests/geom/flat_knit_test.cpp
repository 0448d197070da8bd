#include "geom/flat_knit.h"

#include "tests/geom/tile_fixtures.h"

namespace wale {
namespace {

using namespace test;

const dvec3* ply_of(const FlatYarn& yarn, int ply) { return &yarn.position[ply * yarn.centre.size()]; }

double to_segment(const dvec3& p, const dvec3& a, const dvec3& b) {
  const double t = std::clamp(glm::dot(p - a, b - a) / glm::dot(b - a, b - a), 0.0, 1.0);
  return glm::distance(p, a + t * (b - a));
}

/// Largest distance of the fine polyline's vertices from the coarse polyline, both walked from the same start.
double deviation(const dvec3* fine, size_t fine_count, const dvec3* coarse, size_t coarse_count) {
  double worst = 0;
  size_t near = 0;
  for (size_t i = 0; i < fine_count; ++i) {
    double best = INFINITY;
    size_t best_at = near;
    for (size_t k = near > 2 ? near - 2 : 0; k + 1 < std::min(coarse_count, near + 4); ++k) {
      const double d = to_segment(fine[i], coarse[k], coarse[k + 1]);
      if (d < best) best = d, best_at = k;
    }
    near = best_at;
    worst = std::max(worst, best);
  }
  return worst;
}

/// Rotation of ply 0 about the yarn axis, summed against the least-rotation frame, radians.
double turning(const FlatYarn& yarn, size_t first, size_t last) {
  double sum = 0;
  for (size_t k = first; k < last; ++k) {
    const dvec3 t = glm::normalize(yarn.centre[k + 1] - yarn.centre[k]);
    dvec3 a = yarn.position[k] - yarn.centre[k], b = yarn.position[k + 1] - yarn.centre[k + 1];
    a -= glm::dot(a, t) * t;
    b -= glm::dot(b, t) * t;
    sum += std::atan2(glm::dot(glm::cross(a, b), t), glm::dot(a, b));
  }
  return sum;
}

double axis_length(const FlatYarn& yarn, size_t first, size_t last) {
  double sum = 0;
  for (size_t k = first; k < last; ++k) sum += glm::distance(yarn.centre[k], yarn.centre[k + 1]);
  return sum;
}

TEST(FlatKnit, PolylinesStayWithinTheTolerance) {
  for (const Pattern& tile : {stockinette_pattern(), recut(two_row_tile(), {0.0003, 0.0011}), diagonal_and_ring()})
    for (const dvec3& scale : {dvec3(1), dvec3(1.4, 0.7, 1.2)})
      for (const double pitch : {8.0, -5.0, 0.0})
        for (const double tolerance : {0.02, 0.1}) {
          SCOPED_TRACE(fmt::format("{} pitch {} tolerance {} scale {}", tile.name, pitch, tolerance, scale.x));
          YarnSpec spec = yarn_spec(tile, 3, pitch);
          spec.tolerance = tolerance;
          const InstanceRect rect{{0, 0}, {3, 2}, {0, 0}};
          const std::vector<FlatYarn> coarse = knit_all(tile, spec, rect, scale);
          spec.tolerance = tolerance / 150;
          const std::vector<FlatYarn> fine = knit_all(tile, spec, rect, scale);
          ASSERT_EQ(coarse.size(), fine.size());
          double worst = 0;
          for (size_t y = 0; y < fine.size(); ++y)
            for (int ply = 0; ply < 3; ++ply) {
              const size_t trim = fine[y].closed ? 1 : 0;  // ghosts reach further on the coarse one
              worst = std::max(worst, deviation(ply_of(fine[y], ply) + trim, fine[y].centre.size() - 2 * trim,
                                                ply_of(coarse[y], ply), coarse[y].centre.size()));
            }
          EXPECT_LE(worst, tolerance * spec.ply_radius);
          // Not wastefully fine either, where the tolerance and not the smallest number of samples decides.
          if (tile.name != "diagonal") {
            EXPECT_GE(worst, 0.5 * tolerance * spec.ply_radius);
          }
        }
}

TEST(FlatKnit, PliesLieOnTheHelixAndTouch) {
  const Pattern tile = stockinette_pattern();
  for (int plies = 1; plies <= 8; ++plies) {
    const YarnSpec spec = yarn_spec(tile, plies);
    const std::vector<FlatYarn> yarns = knit_all(tile, spec, {{0, 0}, {4, 2}, {0, 0}});
    ASSERT_EQ(yarns.size(), 2u);
    for (const FlatYarn& yarn : yarns) {
      const size_t count = yarn.centre.size();
      ASSERT_EQ(yarn.position.size(), count * plies);
      ASSERT_EQ(yarn.normal.size(), count * plies);
      ASSERT_EQ(yarn.length.size(), count * plies);
      for (size_t k = 0; k < count; ++k)
        for (int ply = 0; ply < plies; ++ply) {
          EXPECT_NEAR(glm::distance(ply_of(yarn, ply)[k], yarn.centre[k]), spec.helix_radius, 1e-15);
          if (plies > 1) {
            EXPECT_NEAR(glm::distance(ply_of(yarn, ply)[k], ply_of(yarn, (ply + 1) % plies)[k]), 2 * spec.ply_radius,
                        1e-14);
          }
        }
    }
  }
}

TEST(FlatKnit, NormalsAreOrthonormalAndLengthsAreThePolylines) {
  const Pattern tile = recut(two_row_tile(), {0.0003, 0.0011});
  for (const InstanceRect& rect : {InstanceRect{{0, 0}, {3, 2}, {0, 0}}, InstanceRect{{0, 0}, {3, 2}, {3, 2}}})
    for (const FlatYarn& yarn : knit_all(tile, yarn_spec(tile), rect)) {
      const size_t count = yarn.centre.size();
      for (int ply = 0; ply < 3; ++ply) {
        const dvec3* p = ply_of(yarn, ply);
        EXPECT_EQ(yarn.length[ply * count + (yarn.closed ? 1 : 0)], 0);
        for (size_t k = 0; k < count; ++k) {
          const dvec3& n = yarn.normal[ply * count + k];
          EXPECT_NEAR(glm::length(n), 1, 1e-12);
          if (k + 1 < count) {
            EXPECT_NEAR(yarn.length[ply * count + k + 1] - yarn.length[ply * count + k], glm::distance(p[k], p[k + 1]),
                        1e-14);
          }
          if (k > 0 && k + 1 < count) {
            const dvec3 mean = glm::normalize(glm::normalize(p[k] - p[k - 1]) + glm::normalize(p[k + 1] - p[k]));
            EXPECT_NEAR(glm::dot(n, mean), 0, 1e-12);
          }
        }
      }
    }
}

TEST(FlatKnit, PlyNormalsDoNotTwist) {
  // The frame's rotation about the ply, measured edge by edge, vanishes (open yarns).
  const Pattern tile = stockinette_pattern();
  YarnSpec spec = yarn_spec(tile);
  spec.tolerance = 0.002;
  const FlatYarn yarn = knit_all(tile, spec, {{0, 0}, {3, 1}, {0, 0}})[0];
  for (int ply = 0; ply < 3; ++ply) {
    double sum = 0;
    for (size_t k = 0; k + 1 < yarn.centre.size(); ++k) {
      const dvec3 t = glm::normalize(ply_of(yarn, ply)[k + 1] - ply_of(yarn, ply)[k]);
      dvec3 a = yarn.normal[ply * yarn.centre.size() + k], b = yarn.normal[ply * yarn.centre.size() + k + 1];
      a -= glm::dot(a, t) * t;
      b -= glm::dot(b, t) * t;
      sum += std::atan2(glm::dot(glm::cross(a, b), t), glm::dot(a, b));
    }
    EXPECT_NEAR(sum, 0, 0.02);
  }
}

TEST(FlatKnit, TwistTurnsPerMetreAndHandedness) {
  // A tile with torsion of its own, so that frame and twist must be told apart over several passes.
  Pattern tile;
  tile.name = "skew";
  tile.period = {0.01, 0.01};
  tile.yarn_radius = 0.0003;
  PatternCurve curve;
  for (int i = 0; i <= 24; ++i) {
    const double t = i / 24.0, w = 2 * M_PI * t;
    curve.points.push_back({0.01 * t, 0.002 * std::sin(w), 0.0015 * std::cos(w) + 0.0008 * std::sin(2 * w)});
  }
  tile.curves = {curve};
  for (const double pitch : {9.0, -9.0, 0.0}) {
    YarnSpec spec = yarn_spec(tile, 2, pitch);
    spec.tolerance = 0.0005;
    const FlatYarn yarn = knit_all(tile, spec, {{0, 0}, {4, 1}, {0, 0}})[0];
    const size_t last = yarn.centre.size() - 1;
    const double wanted = 2 * M_PI * spec.twist * axis_length(yarn, 0, last);
    EXPECT_NEAR(turning(yarn, 0, last), wanted, 0.003 + 1e-4 * std::abs(wanted));
    if (pitch > 0) {
      EXPECT_GT(wanted, 10);
    }
  }
}

TEST(FlatKnit, PhaseTurnsThePlies) {
  const Pattern tile = stockinette_pattern();
  YarnSpec spec = yarn_spec(tile, 3);
  const FlatYarn a = knit_all(tile, spec, {{0, 0}, {1, 1}, {0, 0}})[0];
  spec.phase = 2 * M_PI / 3;
  const FlatYarn b = knit_all(tile, spec, {{0, 0}, {1, 1}, {0, 0}})[0];
  for (size_t k = 0; k < a.centre.size(); ++k) EXPECT_LT(glm::distance(ply_of(a, 1)[k], ply_of(b, 0)[k]), 1e-15);
}

TEST(FlatKnit, SamplesRepeatExactlyFromTileToTile) {
  const Pattern tile = recut(stockinette_pattern(), {0.0003, 0.0});
  const YarnSpec spec = yarn_spec(tile);
  const dvec3 scale(1.1, 0.9, 1);
  const long per_tile = samples_per_tile(tile, match_partners(tile), spec, scale);
  const FlatYarn yarn = knit_all(tile, spec, {{0, 0}, {6, 1}, {6, 1}}, scale)[0];
  ASSERT_TRUE(yarn.closed);
  const dvec3 period(tile.period.x * scale.x, 0, 0);
  // The wrap may change the twist a little, so this asks for the count that was used.
  const size_t step = (yarn.centre.size() - 3) / 6;
  EXPECT_EQ((yarn.centre.size() - 3) % 6, 0u);
  EXPECT_NEAR(double(step) / per_tile, 1, 0.2);
  for (size_t k = 0; k + step < yarn.centre.size(); ++k)
    EXPECT_LT(glm::distance(yarn.centre[k] + period, yarn.centre[k + step]), 1e-12 * tile.period.x);
}

TEST(FlatKnit, OpenYarnsHaveOneSampleMoreThanTheirLinks) {
  const Pattern tile = two_row_tile();
  const YarnSpec spec = yarn_spec(tile);
  const long per_tile = samples_per_tile(tile, match_partners(tile), spec, dvec3(1));
  size_t sum = 0;
  const std::vector<FlatYarn> yarns = knit_all(tile, spec, {{0, 0}, {5, 3}, {0, 0}});
  for (const FlatYarn& yarn : yarns) sum += yarn.centre.size() - 1;
  EXPECT_EQ(yarns.size(), 6u);
  EXPECT_EQ(sum, size_t(15 * per_tile));
}

TEST(FlatKnit, YarnsBeginAtTheFirstPointOfTheirCurve) {
  const Pattern tile = recut(two_row_tile(), {0.0003, 0.0011});
  const PartnerMap map = match_partners(tile);
  const InstanceRect rect{{1, 2}, {4, 4}, {0, 0}};
  const dvec3 scale(1.2, 0.9, 1.1);
  const std::vector<YarnChain> chains = stitch(tile, map, rect);
  const std::vector<FlatYarn> yarns = knit_all(tile, yarn_spec(tile), rect, scale);
  ASSERT_EQ(chains.size(), yarns.size());
  for (size_t i = 0; i < chains.size(); ++i) {
    const auto end = [&](const Link& link, bool last) {
      const auto& p = tile.curves[link.curve].points;
      return scale * ((last != link.reversed ? p.back() : p.front()) +
                      dvec3(link.instance.x * tile.period.x, link.instance.y * tile.period.y, 0));
    };
    EXPECT_LT(glm::distance(yarns[i].centre.front(), end(chains[i].links.front(), false)), 1e-15);
    EXPECT_LT(glm::distance(yarns[i].centre.back(), end(chains[i].links.back(), true)), 1e-15);
  }
}

void expect_closes(const FlatYarn& yarn, int plies, dvec3 displacement) {
  ASSERT_TRUE(yarn.closed);
  const size_t count = yarn.centre.size();
  for (int ply = 0; ply < plies; ++ply) {
    const dvec3* p = ply_of(yarn, ply);
    const dvec3* n = &yarn.normal[ply * count];
    EXPECT_LT(glm::distance(p[0] + displacement, p[count - 3]), 1e-15);
    EXPECT_LT(glm::distance(p[1] + displacement, p[count - 2]), 1e-15);
    EXPECT_LT(glm::distance(p[2] + displacement, p[count - 1]), 1e-15);
    EXPECT_EQ(n[0], n[count - 3]);
    EXPECT_EQ(n[1], n[count - 2]);
    EXPECT_EQ(n[2], n[count - 1]);
    // The step across the joint is like the steps inside: the ply meets itself, it was not merely copied there.
    double longest = 0, widest = 0;
    for (size_t k = 1; k + 3 < count; ++k) {
      longest = std::max(longest, glm::distance(p[k], p[k + 1]));
      widest = std::max(widest, glm::distance(n[k], n[k + 1]));
    }
    EXPECT_LT(glm::distance(p[count - 3], p[count - 2]), 1.05 * longest);
    EXPECT_LT(glm::distance(n[count - 3], n[count - 2]), 1.2 * widest + 1e-12);
  }
  // Whole turns of the plies against the least-rotation frame need not come out, but the same angle must return.
  const dvec3 a = yarn.position[1] - yarn.centre[1], b = yarn.position[count - 2] - yarn.centre[count - 2];
  EXPECT_LT(glm::distance(a, b), 1e-15);
}

TEST(FlatKnit, ClosedYarnsMeetThemselves) {
  const Pattern tube = two_row_tile(), ring = diagonal_and_ring();
  for (const double pitch : {8.0, -11.0, 0.0})
    for (const int wrap : {1, 2, 5}) {
      const InstanceRect rect{{0, 0}, {wrap, 2}, {wrap, 0}};
      YarnSpec spec = yarn_spec(tube, 3, pitch);
      spec.tolerance = 0.005;
      const std::vector<FlatYarn> yarns = knit_all(tube, spec, rect);
      ASSERT_EQ(yarns.size(), 4u);
      for (const FlatYarn& yarn : yarns) expect_closes(yarn, 3, {wrap * tube.period.x, 0, 0});
      // Closing changes the twist by half a turn at most, twist and frame together.
      const size_t last = yarns[0].centre.size() - 2;
      const double wanted = 2 * M_PI * spec.twist * axis_length(yarns[0], 1, last);
      EXPECT_LE(std::abs(turning(yarns[0], 1, last) - wanted), M_PI * 1.01);

      YarnSpec ring_spec = yarn_spec(ring, 2, pitch);
      for (const FlatYarn& yarn : knit_all(ring, ring_spec, {{0, 0}, {1, 1}, {0, 0}}))
        if (yarn.closed) expect_closes(yarn, 2, dvec3(0));
    }
}

TEST(FlatKnit, SameInputSameBytes) {
  const Pattern tile = recut(two_row_tile(), {0.0003, 0.0011});
  const auto a = knit_all(tile, yarn_spec(tile), {{0, 0}, {3, 3}, {0, 0}});
  const auto b = knit_all(tile, yarn_spec(tile), {{0, 0}, {3, 3}, {0, 0}});
  ASSERT_EQ(a.size(), b.size());
  for (size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].position, b[i].position);
    EXPECT_EQ(a[i].normal, b[i].normal);
    EXPECT_EQ(a[i].length, b[i].length);
  }
}

TEST(FlatKnit, HelixRadiusZeroLaysAllPliesOnTheAxis) {
  const Pattern tile = stockinette_pattern();
  YarnSpec spec = yarn_spec(tile, 2);
  spec.helix_radius = 0;
  const FlatYarn yarn = knit_all(tile, spec, {{0, 0}, {2, 1}, {0, 0}})[0];
  for (size_t k = 0; k < yarn.centre.size(); ++k) {
    EXPECT_EQ(ply_of(yarn, 0)[k], yarn.centre[k]);
    EXPECT_TRUE(std::isfinite(yarn.normal[k].x));
  }
}

TEST(FlatKnit, UnusableSpecsAreRefused) {
  const Pattern tile = stockinette_pattern();
  const InstanceRect rect{{0, 0}, {1, 1}, {0, 0}};
  const auto refused = [&](const std::function<void(YarnSpec&)>& change, const std::string& text) {
    YarnSpec spec = yarn_spec(tile);
    change(spec);
    expect_user_error([&] { knit_all(tile, spec, rect); }, {text});
  };
  refused([](YarnSpec& s) { s.plies = 9; }, "9 plies: choose 1 to 8");
  refused([](YarnSpec& s) { s.plies = 0; }, "0 plies");
  refused([](YarnSpec& s) { s.ply_radius = 0; }, "ply radius");
  refused([](YarnSpec& s) { s.tolerance = NAN; }, "tolerance");
  refused([](YarnSpec& s) { s.twist = INFINITY; }, "finite");
  refused([](YarnSpec& s) { s.helix_radius = -1; }, "helix radius");
  refused([](YarnSpec& s) { s.tolerance = 1e-13; }, "more than");
  expect_user_error([&] { knit_all(tile, yarn_spec(tile), rect, dvec3(1, 0, 1)); }, {"tile scale"});
}

}  // namespace
}  // namespace wale
