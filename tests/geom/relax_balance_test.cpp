// What must hold of the energy of yarns whatever it is made of: no direction is special, forces balance at rest. And
// the solver behind the steps, against a dense one.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <chrono>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <random>

#include "geom/chart/loop_curves.h"
#include "geom/relax/descent.h"
#include "geom/relax/front_factors.h"
#include "geom/relax/starts.h"
#include "geom/relax/step_bound.h"
#include "geom/relax/yarn_terms.h"

namespace wale {
namespace {

// In units of the yarn's diameter.
PeriodicYarns tile_of(const char* chart, bool relaxed, double loop_length = 14) {
  LoopSizes sizes;
  sizes.yarn_radius = 0.5;
  sizes.loop_length = loop_length;
  sizes.step = 0.6;
  PeriodicYarns yarns = loop_curves(knit_chart(parse_chart(chart, "test")), sizes);
  RelaxSettings settings;
  settings.force_tolerance = 1e-6;
  if (relaxed) {
    EXPECT_TRUE(relax(yarns, settings).converged) << chart;
  }
  return yarns;
}

double barrier_of(const PeriodicYarns& yarns) {
  double longest = 0;
  for (const PeriodicYarn& y : yarns.yarns) longest = std::max(longest, y.length / y.count);
  return barrier_for(RelaxSettings().closest, 1.01 * longest, RelaxSettings().contact_samples);
}

TEST(RelaxBalance, NoDirectionIsSpecial) {
  PeriodicYarns y;
  y.points = {{0.1, 0.2, 0.1}, {1.1, 0.6, -0.2}, {2.0, 0.1, 0.3}, {0.3, 0.4, 0.8}, {1.2, -0.2, 0.9}, {2.6, 0.3, 0.7}};
  y.yarns = {{0, 3, {1, 0}, 3.3}, {3, 3, {1, 0}, 3.6}};
  y.period = {4, 3};
  y.radius = 0.5;
  PeriodicYarns turned = y;
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const glm::dquat q = glm::normalize(glm::dquat(normal(random), normal(random), normal(random), normal(random)));
  const dmat3 turn = glm::mat3_cast(q);
  for (dvec3& p : turned.points) p = turn * p + dvec3(0.3, -0.2, 5);
  const auto s = segments_of(y);
  const auto compare = [&](const auto& term) {
    const LocalTerm a = term(y), b = term(turned);
    ASSERT_NE(a.energy, 0);
    EXPECT_NEAR(a.energy, b.energy, 1e-12 * std::abs(a.energy));
    for (int p = 0; p < a.count; ++p) {
      EXPECT_LT(glm::length(turn * a.gradient[p] - b.gradient[p]), 1e-11 * (1 + glm::length(b.gradient[p])));
      for (int r = 0; r <= p; ++r) {
        const dmat3 h = turn * a.hessian[p][r] * glm::transpose(turn);
        for (int c = 0; c < 3; ++c) EXPECT_LT(glm::length(h[c] - b.hessian[p][r][c]), 1e-10 * (1 + glm::length(h[c])));
      }
    }
  };
  compare([&](const PeriodicYarns& at) { return stretch_term(at, s[0], 30, Order::derivatives); });
  compare([&](const PeriodicYarns& at) { return bending_term(at, s[0], s[1], Order::derivatives); });
  compare([&](const PeriodicYarns& at) {
    return contact_term(at, s[0], s[3], {0, 0}, {1.3, 0.4, 20, 4}, Order::derivatives);
  });
}

// Courses that run up instead of across, and the other way round.
TEST(RelaxBalance, ATileTurnedByAQuarterHasTheSameEnergyAndForces) {
  PeriodicYarns y = tile_of("kp\npk", true), turned = y;
  for (dvec3& p : turned.points) p = {-p.y, p.x, p.z};
  for (PeriodicYarn& yarn : turned.yarns) yarn.shift = {-yarn.shift.y, yarn.shift.x};
  turned.period = {y.period.y, y.period.x};
  // Off the state of rest, where there are forces to compare.
  for (PeriodicYarns* tile : {&y, &turned}) tile->points[5] += dvec3(0, 0, 0.02);
  Descent a(y, {}), b(turned, {});
  for (Descent* d : {&a, &b}) d->barrier(1, barrier_of(y)), d->look();
  EXPECT_NEAR(a.energy(), b.energy(), 1e-11 * a.energy());
  EXPECT_GT(a.force(), 0.1);
  EXPECT_NEAR(a.force(), b.force(), 1e-9 * a.force());
  EXPECT_NEAR(a.period_force(), b.period_force(), 1e-9 * a.force());
}

// Yarns hold each other by contact alone: what presses on one of them sums to nothing.
TEST(RelaxBalance, ContactsOfEveryYarnCancelAtRest) {
  for (const char* chart : {"p\nk", "kp\npk", "k2 | ab\nk2 | ba"}) {
    const PeriodicYarns y = tile_of(chart, true);
    const auto segments = segments_of(y);
    const ContactBarrier barrier{1, barrier_of(y), RelaxSettings().contact_stiffness, RelaxSettings().contact_samples};
    std::vector<dvec3> sum(y.yarns.size(), dvec3(0.0));
    std::vector<double> all(y.yarns.size(), 0);
    for (const SegmentPair& pair : near_pairs(y, segments, 1.2, RelaxSettings().neighbours)) {
      const uint32_t a = segments[pair.first].yarn, b = segments[pair.second].yarn;
      if (a == b) continue;
      const LocalTerm t =
          contact_term(y, segments[pair.first], segments[pair.second], pair.image, barrier, Order::derivatives);
      sum[a] += t.gradient[0] + t.gradient[1], sum[b] += t.gradient[2] + t.gradient[3];
      all[a] += glm::length(t.gradient[0] + t.gradient[1]), all[b] += glm::length(t.gradient[2] + t.gradient[3]);
    }
    for (size_t k = 0; k < sum.size(); ++k) {
      EXPECT_GT(all[k], 1) << chart << ": they touch";
      EXPECT_LT(glm::length(sum[k]), 1e-4 * all[k]) << chart << " yarn " << k;
    }
  }
}

TEST(RelaxBalance, NothingPullsAtTheSidesAtRest) {
  for (const char* chart : {"kp", "kp\npk"}) {
    const PeriodicYarns y = tile_of(chart, true);
    const auto energy = [&](const dvec2& strain) {
      TileStep step;
      step.points.assign(y.points.size(), dvec3(0.0));
      step.strain = strain;
      PeriodicYarns at = moved(y, step, 1);
      Descent d(at, {});
      d.barrier(1, barrier_of(y));
      d.look();
      return d.energy();
    };
    constexpr double kStrain = 1e-6;
    for (const dvec2 along : {dvec2(kStrain, 0), dvec2(0, kStrain)}) {
      const double side = along.x > 0 ? y.period.x : y.period.y;
      EXPECT_LT(std::abs(energy(along) - energy(-along)) / (2 * kStrain * side), 1e-4) << chart;
    }
    EXPECT_GT(energy({0.01, 0}), energy({0, 0})) << "it is a minimum";
  }
}

BlockMatrix random_matrix(uint32_t n, uint32_t links, Eigen::MatrixXd& dense) {
  std::mt19937 random(n);
  std::uniform_real_distribution<double> uniform(-1, 1);
  dense.setZero(3 * n, 3 * n);
  std::vector<std::vector<uint32_t>> rows(n);
  for (uint32_t c = 0; c < n; ++c) {
    rows[c].push_back(c);
    if (c + 1 < n) rows[c].push_back(c + 1);
    for (uint32_t k = 0; k < links; ++k)
      if (const uint32_t r = uint32_t(random() % n); r > c + 1) rows[c].push_back(r);
    std::sort(rows[c].begin(), rows[c].end());
    rows[c].erase(std::unique(rows[c].begin(), rows[c].end()), rows[c].end());
  }
  BlockMatrix m;
  m.start = {0};
  for (uint32_t c = 0; c < n; ++c) {
    for (const uint32_t r : rows[c]) {
      dmat3 b(0.0);
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) b[i][j] = uniform(random);
      if (r == c) b = b + glm::transpose(b) + dmat3(4.0 + 2.0 * links);
      m.row.push_back(r);
      m.block.push_back(b);
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) dense(3 * r + j, 3 * c + i) = dense(3 * c + i, 3 * r + j) = b[i][j];
    }
    m.start.push_back(uint32_t(m.row.size()));
  }
  return m;
}

TEST(FrontFactors, SolveAsADenseSolverDoes) {
  for (const auto& [n, links] : {std::pair{1u, 0u}, {2u, 0u}, {30u, 0u}, {60u, 1u}, {90u, 4u}}) {
    Eigen::MatrixXd dense;
    const BlockMatrix m = random_matrix(n, links, dense);
    FrontFactors factors;
    factors.analyse(m);
    const double shift = 0.5 * n / 30;
    ASSERT_TRUE(factors.factorise(m, shift + 2.0 * links));
    dense.diagonal().array() += shift + 2.0 * links;
    Eigen::MatrixXd right = Eigen::MatrixXd::Random(3 * n, 3), x = right;
    factors.solve({x.data(), size_t(x.size())});
    EXPECT_LT((dense * x - right).norm(), 1e-11 * right.norm()) << n << " " << links;
  }
}

// One matrix of a wide cable takes minutes: Ctrl-C and --seconds must not wait for it. By panels, too.
TEST(FrontFactors, StopInAFrontAndGoByPanels) {
  constexpr uint32_t kPoints = 1100;  // 3300 rows in one front
  BlockMatrix m;
  m.start = {0};
  for (uint32_t c = 0; c < kPoints; ++c) {
    for (uint32_t r = c; r < kPoints; ++r) {
      m.row.push_back(r);
      m.block.push_back(r == c ? dmat3(2.0) : dmat3(1.0 / (1 + r + c)));
    }
    m.start.push_back(uint32_t(m.row.size()));
  }
  FrontFactors factors;
  factors.analyse(m);
  int asked = 0;
  EXPECT_FALSE(factors.factorise(m, 1, [&] { return ++asked == 3; }));
  EXPECT_EQ(asked, 3);
  ASSERT_TRUE(factors.factorise(m, 1));
  std::vector<double> x(3 * kPoints, 1.0);
  factors.solve(x);
  for (const uint32_t i : {0u, 1u, 500u, kPoints - 1}) {
    double sum = 0;
    for (uint32_t k = 0; k < kPoints; ++k) sum += (k == i ? 3.0 : 1.0 / (1 + k + i)) * x[3 * k];
    EXPECT_NEAR(sum, 1, 1e-12) << i;
  }
}

TEST(FrontFactors, RefuseWhatIsNotPositiveDefinite) {
  Eigen::MatrixXd dense;
  const BlockMatrix m = random_matrix(40, 2, dense);
  FrontFactors factors;
  factors.analyse(m);
  const double least = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(dense).eigenvalues()[0];
  EXPECT_TRUE(factors.factorise(m, -least + 1e-6));
  EXPECT_FALSE(factors.factorise(m, -least - 1e-6));
  EXPECT_TRUE(factors.factorise(m, -least + 1e-6)) << "and goes on afterwards";
}

TEST(RelaxStarts, LowestOfSeveralIsKeptWhateverTheThreads) {
  const PeriodicYarns start = tile_of("kp\npk", false, 15);
  PeriodicYarns alone = start, one = start, three = start;
  const Relaxed first = relax_from_starts(alone, {}, 1, 1);
  const Relaxed best = relax_from_starts(one, {}, 6, 1), again = relax_from_starts(three, {}, 6, 3);
  EXPECT_EQ(one.points, three.points);
  EXPECT_EQ(best.energy, again.energy);
  EXPECT_LT(best.energy, first.energy) << "this tile has several states of rest";
  PeriodicYarns by_hand = start;
  EXPECT_EQ(relax(by_hand, {}).energy, first.energy) << "the first start is where the yarns are";
}

// All starts share the time, and what depends on how many of them came to their end is no result.
TEST(RelaxStarts, TimeIsThatOfAllStartsTogether) {
  PeriodicYarns y = tile_of("k2p2\nk2p2\np2k2\np2k2", false);
  RelaxSettings settings;
  settings.max_seconds = 0.3;
  const auto start = std::chrono::steady_clock::now();
  const Relaxed reached = relax_from_starts(y, settings, 64, 1);
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 5) << "64 x 0.3 s is 19 s";
  EXPECT_EQ(reached.end, RelaxEnd::time);
  EXPECT_FALSE(reached.converged);
}

TEST(RelaxStarts, ShakingMovesEveryYarnAndLetsNonePassAnother) {
  const PeriodicYarns start = tile_of("kp\npk", false);
  PeriodicYarns a = start, b = start;
  shake(a, 0.2, 2, 1), shake(b, 0.2, 2, 2);
  EXPECT_NE(a.points, b.points);
  for (size_t i = 0; i < a.points.size(); ++i) {
    EXPECT_NE(a.points[i], start.points[i]);
    EXPECT_LT(glm::distance(a.points[i], start.points[i]), 1);
  }
  // Shaken wildly they stop short of each other, however far they were to go.
  for (uint64_t seed = 1; seed <= 8; ++seed) {
    PeriodicYarns wild = start;
    shake(wild, 20, 2, seed);
    EXPECT_GT(closest_distance(wild, 2, 2), 0.05 * closest_distance(start, 2, 2)) << seed;
    for (size_t i = 0; i < wild.points.size(); ++i)
      EXPECT_LE(std::abs(wild.points[i].z - start.points[i].z), 1) << "half of what is looked at for neighbours";
  }
}

}  // namespace
}  // namespace wale
