// The plan of `wale cost` keeps its time; clocks are the tests' own.
#include <numeric>

#include "host/cost/bias.h"
#include "host/cost/schedule.h"
#include "host/film.h"
#include "tests/temporary_folder.h"

namespace wale::cost {
namespace {

double planned_seconds(const RunPlan& plan) {
  return plan.repetitions * std::accumulate(plan.predicted.begin(), plan.predicted.end(), 0.0);
}

const std::vector<UnitPrice> kPrices = {{0.01, 0, true}, {0.02, 0, true}, {0.01, 0, false}, {0.015, 0.3, false}};

TEST(CostSchedule, UsesTheTimeAndNoMore) {
  for (const double seconds : {10.0, 60.0, 600.0}) {
    const RunPlan plan = plan_runs(kPrices, seconds);
    EXPECT_GE(plan.repetitions, kFewestRepetitions);
    EXPECT_LE(planned_seconds(plan), seconds);
    EXPECT_GT(planned_seconds(plan), 0.6 * seconds);
    for (const int samples : plan.samples) {
      EXPECT_GT(samples, 0);
      EXPECT_EQ(samples % int(kScrambles), 0);
      EXPECT_EQ(samples, plan.samples[0]);  // prices are near each other
    }
  }
}

TEST(CostSchedule, DearUnitsHaveFewerSamples) {
  std::vector<UnitPrice> prices = kPrices;
  prices.push_back({1.0, 0, false});
  const RunPlan plan = plan_runs(prices, 1000);
  EXPECT_GT(plan.samples[4], 0);
  EXPECT_LT(plan.samples[4], plan.samples[0] / 8);
  EXPECT_LE(planned_seconds(plan), 1000);
}

TEST(CostSchedule, WhatDoesNotFitIsLeftOutButNeverTheNeeded) {
  std::vector<UnitPrice> prices = kPrices;
  prices.push_back({10.0, 0, false});  // 4 repetitions of 8 samples: 320 s
  prices[1] = {0.5, 0, true};
  const RunPlan plan = plan_runs(prices, 60);
  EXPECT_EQ(plan.samples[4], 0);
  for (size_t u = 0; u < 4; ++u) EXPECT_GT(plan.samples[u], 0);
  EXPECT_LE(planned_seconds(plan), 60);
  EXPECT_EQ(plan_runs(prices, 10).repetitions, 0);  // the needed ones alone take 16.3 s
  EXPECT_NEAR(least_seconds(prices), 4 * 8 * 0.51, 1e-9);
}

TEST(CostSchedule, UnitsTakeTurns) {
  const RunPlan plan{3, 3, {8, 0, 16}, {1, 0, 1}};
  double now = 0;
  std::vector<std::pair<size_t, int>> order;
  EXPECT_TRUE(run_interleaved(
      plan, 100, [&] { return now; },
      [&](size_t u, int repetition, int samples) {
        EXPECT_EQ(samples, plan.samples[u]);
        order.push_back({u, repetition});
        now += 1;
        return true;
      }));
  EXPECT_EQ(order, (std::vector<std::pair<size_t, int>>{{0, 0}, {2, 0}, {0, 1}, {2, 1}, {0, 2}, {2, 2}}));
}

// Renders that take `slower` times what was planned end within the deadline and, but for the first, a render of it.
TEST(CostSchedule, ASlowMachineKeepsTheTime) {
  for (const double slower : {0.7, 1.0, 1.6, 5.0}) {
    const RunPlan plan = plan_runs(kPrices, 100);
    double now = 7;
    int renders = 0;
    const bool done = run_interleaved(
        plan, 107, [&] { return now; },
        [&](size_t u, int, int) {
          now += slower * plan.predicted[u];
          ++renders;
          return true;
        });
    EXPECT_EQ(done, slower <= 1);
    EXPECT_LE(now, 107 + 1e-9);
    EXPECT_GT(renders, 2);
    if (!done) {
      EXPECT_GT(now, 107 - 3 * slower * plan.predicted[1]);
    }
  }
}

// What is left after the plan goes to more repetitions.
TEST(CostSchedule, AFastMachineRepeatsMore) {
  const RunPlan plan = plan_runs(kPrices, 100);
  double now = 0;
  int last = 0;
  EXPECT_TRUE(run_interleaved(
      plan, 100, [&] { return now; },
      [&](size_t u, int repetition, int) {
        now += 0.5 * plan.predicted[u];
        last = repetition;
        return true;
      }));
  EXPECT_GT(last + 1, 3 * plan.repetitions / 2);
  EXPECT_LE(now, 100);
  EXPECT_EQ(plan_runs(kPrices, 100, 6).most_repetitions, 6);
}

TEST(CostSchedule, EndsWhenTheUserAsks) {
  const RunPlan plan{3, 3, {8, 8}, {1, 1}};
  int renders = 0;
  EXPECT_FALSE(run_interleaved(
      plan, 100, [] { return 0.0; }, [&](size_t, int, int) { return ++renders < 4; }));
  EXPECT_EQ(renders, 4);
}

}  // namespace
}  // namespace wale::cost
