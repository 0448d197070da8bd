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

// Straight lines through noisy points: deviations and correlation against what many fits show.
TEST(FitLeastSquares, DeviationsAreThoseOfManyFits) {
  const int points = 40, fits = 2000;
  std::vector<std::vector<double>> columns(2);
  for (int i = 0; i < points; ++i) columns[0].push_back(1), columns[1].push_back(1 + double(i) / points);
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 0.02);
  double sum[2] = {0, 0}, squares[2] = {0, 0}, product = 0;
  Residuals last;
  for (int f = 0; f < fits; ++f) {
    std::vector<double> y(points);
    for (double& v : y) v = noise(random);
    const auto line = [&](std::span<const double> x, bool) {
      Residuals r{{{}}};
      for (int i = 0; i < points; ++i)
        r.replicates[0].values.push_back((x[0] - 0.5) + (x[1] - 0.5) * columns[1][size_t(i)] - y[size_t(i)]);
      return r;
    };
    const std::vector<double> start{0.5, 0.5};
    LeastSquaresOptions options;
    options.least_gain = 1e-9;
    options.least_step = 1e-9;
    const LeastSquaresResult r = least_squares(line, start, options);
    last = r.residuals;
    for (int k = 0; k < 2; ++k) {
      sum[k] += r.x[size_t(k)] / fits;
      squares[k] += r.x[size_t(k)] * r.x[size_t(k)] / fits;
    }
    product += r.x[0] * r.x[1] / fits;
  }
  // The variance of the points as it is, not as one fit sees it.
  last.replicates[0].values.assign(points, 0.02 * std::sqrt((points - 2.0) / points));
  const ParameterErrors errors = parameter_errors(last);
  const double deviation[2] = {std::sqrt(squares[0] - sum[0] * sum[0]), std::sqrt(squares[1] - sum[1] * sum[1])};
  for (size_t k = 0; k < 2; ++k) {
    ASSERT_TRUE(errors.deviations[k]);
    EXPECT_NEAR(*errors.deviations[k], deviation[k], 0.05 * deviation[k]);
  }
  const double correlation = (product - sum[0] * sum[1]) / (deviation[0] * deviation[1]);
  EXPECT_NEAR(errors.correlation[0][1], correlation, 0.01);
  EXPECT_EQ(errors.alike(0.95).size(), 1u);
  EXPECT_TRUE(errors.alike(0.99).empty() || std::abs(correlation) > 0.99);
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

// Two axes that do the same, and one that does nothing: none of them is known.
TEST(FitLeastSquares, NamesWhatIsNotDetermined) {
  const std::vector<std::vector<double>> columns{{1, 2, 3, 5}, {2, 4, 6, 10}, {0, 0, 0, 0}, {1, -1, 1, -1}};
  const ParameterErrors errors = parameter_errors({{{{0.01, 0.01, 0.01, 0.01}, columns}}});
  EXPECT_FALSE(errors.deviations[0]);
  EXPECT_FALSE(errors.deviations[1]);
  EXPECT_FALSE(errors.deviations[2]);
  EXPECT_TRUE(errors.deviations[3]);
}

}  // namespace
}  // namespace wale::fit
