// Terms of the energy of relaxed yarns against finite differences of it, and the step that lets no yarn pass another.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "geom/relax/contact_term.h"
#include "geom/relax/resolution.h"
#include "geom/relax/step_bound.h"
#include "geom/relax/yarn_terms.h"

namespace wale {
namespace {

// A yarn of four points and one of three, that cross tile borders.
PeriodicYarns two_yarns() {
  PeriodicYarns y;
  y.points = {{0.1, 0.2, 0.1}, {1.1, 0.6, -0.2}, {2.0, 0.1, 0.3}, {3.2, -0.3, 0.1},
              {0.3, 0.4, 0.8}, {1.2, -0.2, 0.9}, {2.6, 0.3, 0.7}};
  y.yarns = {{0, 4, {1, 0}, 4.4}, {4, 3, {1, 0}, 4.2}};
  y.period = {4, 3};
  y.radius = 0.5;
  return y;
}

// Checks a term against central differences along random steps: first ones of the energy, then ones of the gradient.
template <typename Term>
void expect_derivatives(const PeriodicYarns& at, const Term& term) {
  constexpr double kStep = 1e-5, kFirst = 1e-7, kSecond = 1e-6;  // relative; differences lose half the digits
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const LocalTerm here = term(at, Order::derivatives);
  ASSERT_NE(here.energy, 0);
  EXPECT_EQ(here.energy, term(at, Order::energy).energy);
  const auto slope = [](const LocalTerm& t, const TileStep& s) {
    double sum = glm::dot(t.strain_gradient, s.strain);
    for (int p = 0; p < t.count; ++p) sum += glm::dot(t.gradient[p], s.points[t.point[p]]);
    return sum;
  };
  for (int trial = 0; trial < 10; ++trial) {
    TileStep step;
    for (size_t i = 0; i < at.points.size(); ++i)
      step.points.emplace_back(uniform(random), uniform(random), uniform(random));
    step.strain = {uniform(random), uniform(random)};
    const LocalTerm up = term(moved(at, step, kStep), Order::derivatives);
    const LocalTerm down = term(moved(at, step, -kStep), Order::derivatives);
    const double first = (up.energy - down.energy) / (2 * kStep);
    EXPECT_NEAR(slope(here, step), first, kFirst * (1 + std::abs(first)));
    // e^T d2E e. The strain of the moved tile is counted from where it is: d/de there is (1 + e) d/de here.
    TileStep from_up = step, from_down = step;
    from_up.strain = step.strain / (1.0 + kStep * step.strain);
    from_down.strain = step.strain / (1.0 - kStep * step.strain);
    // u is not scaled, but points moved by u are strained on: take that part of the motion off.
    for (size_t i = 0; i < at.points.size(); ++i) {
      from_up.points[i] -= kStep * dvec3(from_up.strain, 0) * step.points[i];
      from_down.points[i] += kStep * dvec3(from_down.strain, 0) * step.points[i];
    }
    const double second = (slope(up, from_up) - slope(down, from_down)) / (2 * kStep);
    double quadratic = here.strain_hessian[0] * step.strain.x * step.strain.x +
                       2 * here.strain_hessian[1] * step.strain.x * step.strain.y +
                       here.strain_hessian[2] * step.strain.y * step.strain.y;
    for (int p = 0; p < here.count; ++p) {
      const dvec3& u = step.points[here.point[p]];
      for (int k = 0; k < 2; ++k) quadratic += 2 * step.strain[k] * glm::dot(u, here.border[p][k]);
      for (int q = 0; q <= p; ++q)
        quadratic += (q < p ? 2 : 1) * glm::dot(u, here.hessian[p][q] * step.points[here.point[q]]);
    }
    EXPECT_NEAR(quadratic, second, kSecond * (1 + std::abs(second)));
  }
}

TEST(RelaxTerms, StretchFollowsFiniteDifferences) {
  const PeriodicYarns y = two_yarns();
  const auto segments = segments_of(y);
  for (const YarnSegment& s : segments)
    expect_derivatives(y, [&](const PeriodicYarns& at, Order order) { return stretch_term(at, s, 30, order); });
}

TEST(RelaxTerms, BendingFollowsFiniteDifferences) {
  const PeriodicYarns y = two_yarns();
  const auto s = segments_of(y);
  expect_derivatives(y, [&](const PeriodicYarns& at, Order order) { return bending_term(at, s[0], s[1], order); });
  expect_derivatives(y, [&](const PeriodicYarns& at, Order order) { return bending_term(at, s[3], s[0], order); });
}

TEST(RelaxTerms, ContactFollowsFiniteDifferences) {
  const PeriodicYarns y = two_yarns();
  const auto s = segments_of(y);
  const ContactBarrier barrier{1.3, 0.4, 20, 4};
  expect_derivatives(y, [&](const PeriodicYarns& at, Order order) {
    return contact_term(at, s[0], s[4], {0, 0}, barrier, order);
  });
  expect_derivatives(y, [&](const PeriodicYarns& at, Order order) {
    return contact_term(at, s[3], s[4], {1, 0}, barrier, order);
  });
}

TEST(RelaxTerms, ContactIsInfiniteWithinTheBarrier) {
  PeriodicYarns y = two_yarns();
  for (size_t i = 4; i < 7; ++i) y.points[i] = y.points[i - 4] + dvec3(0.0, 0.0, 0.3);
  const auto s = segments_of(y);
  EXPECT_EQ(contact_term(y, s[0], s[4], {0, 0}, {1, 0.5, 1, 4}, Order::energy).energy, INFINITY);
}

// Two straight yarns, one above the other; the upper one is sent down through the lower one.
TEST(StepBound, NoYarnPassesAnotherOnAWholeStep) {
  PeriodicYarns y;
  for (int i = 0; i < 4; ++i) y.points.emplace_back(i, 0, 0);
  for (int i = 0; i < 4; ++i) y.points.emplace_back(0, i, 1);
  y.yarns = {{0, 4, {1, 0}, 4}, {4, 4, {0, 1}, 4}};
  y.period = {4, 4};
  y.radius = 0.5;
  TileStep down;
  down.points.assign(8, dvec3(0.0));
  for (size_t i = 4; i < 8; ++i) down.points[i].z = -3;
  const auto segments = segments_of(y);
  for (int step = 0; step < 30; ++step) {
    const double share = safe_share(y, segments, near_pairs(y, segments, 1.8, 2), 1.8, 1, down);
    y = moved(y, down, share);
    ASSERT_GT(y.points[4].z, 0) << "passed on step " << step;
  }
  EXPECT_LT(y.points[4].z, 0.01) << "the bound must not stop steps that are safe";
  // The step as it is would have taken it through.
  EXPECT_LT(moved(y, down, 1).points[4].z, 0);
}

TEST(StepBound, StrainThatFoldsTheTileIsCut) {
  PeriodicYarns y = two_yarns();
  const auto segments = segments_of(y);
  TileStep fold;
  fold.points.assign(y.points.size(), dvec3(0.0));
  fold.strain = {-2, 0};
  const double share = safe_share(y, segments, near_pairs(y, segments, 1.8, 2), 1.8, 1, fold);
  EXPECT_GT(moved(y, fold, share).period.x, 0);
}

TEST(Resolution, CuttingSegmentsInTwoMovesNothingAndComesBack) {
  const PeriodicYarns y = two_yarns(), fine = refined(y);
  ASSERT_EQ(fine.points.size(), 2 * y.points.size());
  EXPECT_DOUBLE_EQ(closest_of(fine, segments_of(fine), {0, 8, {0, 0}}).way.x,
                   closest_of(y, segments_of(y), {0, 4, {0, 0}}).way.x);
  const PeriodicYarns finer = refined(refined(fine));
  const auto coarse = coarsened(finer, 2);
  ASSERT_TRUE(coarse);
  for (size_t i = 0; i < coarse->points.size(); ++i)
    EXPECT_LT(glm::length(coarse->points[i] - refined(fine).points[i]), 1e-15);
  EXPECT_FALSE(coarsened(y, 2)) << "an odd number of points";
}

}  // namespace
}  // namespace wale
