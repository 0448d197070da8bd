#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "host/fit/bobyqa.h"
#include "host/fit/least_squares.h"

namespace wale::fit {
namespace {

// Rosenbrock's valley, its floor's end at (0.75, 0.5625) of the box.
Residuals valley(std::span<const double> x, bool) {
  const double a = x[0] / 0.75, b = x[1] / 0.5625;
  return {{{{1 - a, 10 * (b - a * a)}}}};
}

TEST(FitLeastSquares, FindsTheEndOfAValley) {
  const std::vector<double> start{0.1, 0.9};
  LeastSquaresOptions options;
  options.least_step = 1e-7;
  options.least_gain = 1e-12;
  options.difference = 1e-5;
  const LeastSquaresResult r = least_squares(valley, start, options);
  EXPECT_TRUE(r.converged);
  EXPECT_NEAR(r.x[0], 0.75, 1e-4);
  EXPECT_NEAR(r.x[1], 0.5625, 2e-4);
  EXPECT_LT(r.evaluations, 100);
}

// Given derivatives take the place of differences: they are exact, and nothing is evaluated for them.
TEST(FitLeastSquares, TakesDerivativesThatAreGiven) {
  int asked = 0;
  const auto given = [&](std::span<const double> x, bool derivatives) {
    ++asked;
    Residuals r = valley(x, false);
    const double a = x[0] / 0.75;
    if (derivatives) r.replicates[0].derivatives = {{-1 / 0.75, -20 * a / 0.75}, {0, 10 / 0.5625}};
    return r;
  };
  const std::vector<double> start{0.1, 0.9};
  LeastSquaresOptions options;
  options.least_step = 1e-7;
  options.least_gain = 1e-12;
  options.difference = 1e-5;
  const LeastSquaresResult with = least_squares(given, start, options);
  const LeastSquaresResult without = least_squares(valley, start, options);
  EXPECT_NEAR(with.x[0], 0.75, 1e-4);
  EXPECT_EQ(asked, with.evaluations);
  EXPECT_LT(2 * with.evaluations, without.evaluations * 1.5);
}

// The least place lies outside of the box: the bound holds, and the other axis still finds its own.
TEST(FitLeastSquares, StaysInTheBox) {
  const auto f = [](std::span<const double> x, bool) {
    for (const double v : x) {
      EXPECT_GE(v, 0);
      EXPECT_LE(v, 1);
    }
    return Residuals{{{{x[0] - 1.7, x[1] - 0.3 + 0.1 * (x[0] - 1.7)}}}};
  };
  const std::vector<double> start{0.2, 0.9};
  LeastSquaresOptions options;
  options.least_step = 1e-6;
  options.least_gain = 1e-10;
  const LeastSquaresResult r = least_squares(f, start, options);
  EXPECT_DOUBLE_EQ(r.x[0], 1);
  EXPECT_NEAR(r.x[1], 0.37, 1e-4);
}

TEST(FitLeastSquares, StopsWhenItIsTold) {
  int calls = 0;
  const auto f = [&](std::span<const double> x, bool) {
    ++calls;
    return valley(x, false);
  };
  LeastSquaresOptions options;
  options.evaluations = 7;
  const std::vector<double> start{0.1, 0.9};
  const LeastSquaresResult r = least_squares(f, start, options);
  EXPECT_FALSE(r.converged);
  EXPECT_LE(calls, 7 + 2);  // a round of differences is finished
  EXPECT_LT(r.residuals.loss(), valley(start, false).loss());
}

TEST(FitLeastSquares, BobyqaFindsItFromValuesAlone) {
  const std::vector<double> start{0.1, 0.9};
  const BobyqaResult r = bobyqa([](std::span<const double> x) { return valley(x, false).loss(); }, start, 1000, 1e-7,
                                [] { return false; });
  EXPECT_TRUE(r.converged);
  EXPECT_NEAR(r.x[0], 0.75, 1e-3);
  EXPECT_NEAR(r.x[1], 0.5625, 2e-3);
}

TEST(FitLeastSquares, BobyqaHandsErrorsOn) {
  const std::vector<double> start{0.1, 0.9};
  EXPECT_THROW(bobyqa([](std::span<const double>) -> double { throw std::runtime_error("no"); }, start, 100, 1e-7,
                      [] { return false; }),
               std::runtime_error);
}

// Two replicates' derivatives of which noise has made the product negative.
ResidualFunction without_curvature(double truth, std::vector<double>& asked) {
  return [truth, &asked](std::span<const double> x, bool) {
    asked.push_back(x[0]);
    const double value = std::abs(x[0] - truth) + 0.01;
    return Residuals{{{{value}, {{1.0}}}, {{value}, {{-0.5}}}}};
  };
}

TEST(FitLeastSquares, WithoutCurvatureStepsBecomeShorterAllTheSame) {
  std::vector<double> asked;
  const std::vector<double> start{0.5};
  const LeastSquaresResult r = least_squares(without_curvature(0.4, asked), start);
  EXPECT_NEAR(r.x[0], 0.4, 0.03);
  EXPECT_LT(asked.size(), 30u);
}

TEST(FitLeastSquares, WithoutCurvatureBlindStepsAreNoConvergence) {
  for (const double level : {0.5, 0.505}) {
    std::vector<double> asked;
    const std::vector<double> start{0.5};
    const LeastSquaresResult r = least_squares(without_curvature(level, asked), start);
    EXPECT_FALSE(r.converged) << level;
    EXPECT_DOUBLE_EQ(r.x[0], 0.5);
    EXPECT_LT(std::abs(asked.back() - 0.5), 0.2) << level;  // not the same corner of the box again and again
  }
}

// Noise that grows along the axis: squares are least where there is little of it, products of two replicates are not.
TEST(FitLeastSquares, ProductsOfReplicatesAreNotDrawnToWhereNoiseIsLeast) {
  constexpr int kPoints = 4000;
  std::vector<double> noise[2];
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0, 1);
  for (auto& n : noise)
    for (int i = 0; i < kPoints; ++i) n.push_back(normal(random));
  const auto fitted = [&](size_t replicates) {
    const auto f = [&](std::span<const double> x, bool) {
      Residuals r;
      for (size_t k = 0; k < replicates; ++k) {
        Replicate& one = r.replicates.emplace_back();
        for (int i = 0; i < kPoints; ++i) one.values.push_back(x[0] - 0.6 + x[0] * noise[k][size_t(i)]);
      }
      return r;
    };
    const std::vector<double> start{0.9};
    LeastSquaresOptions options;
    options.least_step = 1e-6;
    options.least_gain = 1e-9;
    return least_squares(f, start, options).x[0];
  };
  EXPECT_NEAR(fitted(1), 0.3, 0.03);  // the least of (x - 0.6)^2 + x^2
  EXPECT_NEAR(fitted(2), 0.6, 0.03);
}

}  // namespace
}  // namespace wale::fit
