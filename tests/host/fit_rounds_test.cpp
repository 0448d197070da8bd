// Least-squares steps from many noisy renders: where they lead, and how sure they are of it.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "host/fit/polish.h"
#include "host/fit/rounds.h"

namespace wale::fit {
namespace {

constexpr size_t kPixels = 3000, kRun = 5;
constexpr int kCells = 30;

// Pictures that are straight lines in the axes, a photograph of them with noise that neighbours share, and rounds whose
// values and derivatives are noisy together, as those of one render are.
class NoisyPictures {
 public:
  NoisyPictures(uint32_t seed, size_t axes, double derivative_noise) : noise_(derivative_noise), random_(seed) {
    columns_.resize(axes);
    std::mt19937 fixed(1);
    for (auto& column : columns_)
      for (size_t i = 0; i < kPixels; ++i) column.push_back(0.1 * normal_(fixed));
    for (size_t i = 0; i < kPixels; ++i) cells.push_back(int(i * kCells / kPixels));
    for (size_t i = 0; i < kPixels; i += kRun) photograph_.insert(photograph_.end(), kRun, 0.05 * normal_(random_));
  }

  Replicate round(std::span<const double> x, std::span<const double> truth) {
    Replicate out;
    out.derivatives.resize(columns_.size());
    for (size_t i = 0; i < kPixels; ++i) {
      const double luck = normal_(random_);
      double value = 0.3 * luck - photograph_[i];
      for (size_t k = 0; k < columns_.size(); ++k) {
        value += columns_[k][i] * (x[k] - truth[k]);
        out.derivatives[k].push_back(columns_[k][i] + noise_ * (luck + normal_(random_)));
      }
      out.values.push_back(value);
    }
    return out;
  }

  std::vector<int> cells;
  std::vector<std::vector<double>> columns_;

 private:
  double noise_;
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
  std::vector<double> photograph_;
};

const std::vector<double> kHere{0.5, 0.5}, kTruth{0.55, 0.47};

// Noise of derivatives is three times themselves. Many such steps: no bias, and errors as large as they say.
TEST(FitRounds, FindsTheTruthWithTheErrorsThatItSays) {
  constexpr int kFits = 150, kRoundCount = 8;
  double mean[2] = {}, squares[2] = {}, said[2] = {};
  for (int f = 0; f < kFits; ++f) {
    NoisyPictures pictures(uint32_t(100 + f), 2, 0.3);
    Rounds rounds(pictures.cells);
    for (int k = 0; k < kRoundCount; ++k) rounds.add(pictures.round(kHere, kTruth));
    const Rounds::Step step = rounds.solve(kHere, 0.5);
    for (size_t k = 0; k < 2; ++k) {
      const double error = step.x[k] - kTruth[k];
      ASSERT_TRUE(step.errors.deviations[k]);
      mean[k] += error / kFits;
      squares[k] += error * error / kFits;
      said[k] += *step.errors.deviations[k] / kFits;
    }
  }
  for (size_t k = 0; k < 2; ++k) {
    const double deviation = std::sqrt(squares[k]);
    EXPECT_LT(std::abs(mean[k]), 4 * deviation / std::sqrt(kFits)) << k;
    EXPECT_NEAR(said[k] / deviation, 1, 0.25) << k;
    EXPECT_LT(deviation, 0.06) << k;
  }
}

// The loss is that of the mean picture: the rounds' own noise is not in it, the photograph's is.
TEST(FitRounds, LossHasNoNoiseOfRounds) {
  double sum = 0;
  constexpr int kFits = 40;
  for (int f = 0; f < kFits; ++f) {
    NoisyPictures pictures(uint32_t(f), 2, 0.3);
    Rounds rounds(pictures.cells);
    for (int k = 0; k < 4; ++k) rounds.add(pictures.round(kTruth, kTruth));
    sum += rounds.loss() / kFits;
  }
  EXPECT_NEAR(sum, kPixels * 0.05 * 0.05, 0.8);
}

TEST(FitRounds, StaysWithinReachAndBox) {
  NoisyPictures pictures(3, 2, 0.02);
  const std::vector<double> here{0.98, 0.5}, truth{1.3, 0.2};
  Rounds rounds(pictures.cells);
  for (int k = 0; k < 4; ++k) rounds.add(pictures.round(here, truth));
  const Rounds::Step step = rounds.solve(here, 0.1);
  EXPECT_DOUBLE_EQ(step.x[0], 1);
  EXPECT_DOUBLE_EQ(step.x[1], 0.4);
}

// Axis 1 does twice what axis 0 does, axis 2 nothing: none of the three is known, and none moves far.
TEST(FitRounds, NamesWhatIsNotDetermined) {
  NoisyPictures pictures(4, 4, 0);
  pictures.columns_[2].assign(kPixels, 0.0);
  for (size_t i = 0; i < kPixels; ++i) pictures.columns_[1][i] = 2 * pictures.columns_[0][i];
  const std::vector<double> here{0.5, 0.5, 0.5, 0.5}, truth{0.5, 0.5, 0.5, 0.55};
  Rounds rounds(pictures.cells);
  for (int k = 0; k < 8; ++k) rounds.add(pictures.round(here, truth));
  const Rounds::Step step = rounds.solve(here, 0.5);
  const auto least = [&](size_t k) { return step.errors.deviations[k].value_or(1.0); };
  EXPECT_GT(least(0), 0.25);
  EXPECT_GT(least(1), 0.25);
  EXPECT_FALSE(step.errors.deviations[2]);
  EXPECT_LT(least(3), 0.05);
  EXPECT_NEAR(step.x[2], 0.5, 1e-6);
  EXPECT_NEAR(step.x[3], 0.55, 4 * least(3));
  EXPECT_EQ(step.errors.alike(0.95), (std::vector<std::pair<size_t, size_t>>{{0, 1}}));
}

// One window has no spread, and two have one direction of it: the step is taken, errors are not made up.
TEST(FitRounds, TooFewCellsMoveButStateNoErrors) {
  for (const int count : {1, 2, 3}) {
    NoisyPictures pictures(7, 3, 0.05);
    for (size_t i = 0; i < kPixels; ++i) pictures.cells[i] = int(i) % count;
    const std::vector<double> here{0.5, 0.5, 0.5}, truth{0.55, 0.47, 0.52};
    Rounds rounds(pictures.cells);
    for (int k = 0; k < 8; ++k) rounds.add(pictures.round(here, truth));
    const Rounds::Step step = rounds.solve(here, 0.5);
    EXPECT_TRUE(step.errors.too_few_cells) << count;
    EXPECT_TRUE(step.errors.alike(0.95).empty()) << count;
    EXPECT_TRUE(std::isfinite(step.loss)) << count;
    for (size_t k = 0; k < 3; ++k) {
      EXPECT_FALSE(step.errors.deviations[k]) << count;
      EXPECT_NEAR(step.x[k], truth[k], 0.03) << count << ' ' << k;
    }
  }
  NoisyPictures enough(7, 3, 0.05);
  for (size_t i = 0; i < kPixels; ++i) enough.cells[i] = int(i) % 4;
  Rounds rounds(enough.cells);
  const std::vector<double> here{0.5, 0.5, 0.5};
  for (int k = 0; k < 8; ++k) rounds.add(enough.round(here, here));
  EXPECT_FALSE(rounds.solve(here, 0.5).errors.too_few_cells);
}

// Nothing is known of axes that change nothing; not-a-number would be carried into the material.
TEST(FitRounds, AxesThatChangeNothingStayWhereTheyAre) {
  for (const int count : {1, kCells}) {
    NoisyPictures pictures(8, 2, 0);
    for (auto& column : pictures.columns_) column.assign(kPixels, 0.0);
    for (size_t i = 0; i < kPixels; ++i) pictures.cells[i] = int(i) % count;
    Rounds rounds(pictures.cells);
    for (int k = 0; k < 3; ++k) rounds.add(pictures.round(kHere, kTruth));
    const Rounds::Step step = rounds.solve(kHere, 0.5);
    EXPECT_EQ(step.x, kHere) << count;
    EXPECT_FALSE(step.errors.deviations[0] || step.errors.deviations[1]) << count;
    EXPECT_EQ(step.errors.too_few_cells, count == 1);
  }
}

// Steps without errors are short when they end before their reach, so that a far truth is come to all the same.
TEST(FitRounds, PolishOfOneCellGoesOnFromStepToStep) {
  NoisyPictures pictures(9, 2, 0.05);
  pictures.cells.assign(kPixels, 0);
  const std::vector<double> far{0.1, 0.5}, truth{0.9, 0.36};
  const Polished polished =
      polish([&](std::span<const double> x, int, uint32_t) { return pictures.round(x, truth); }, far, 960,
             pictures.cells, [] { return false; }, [](std::span<const double>, double) {});
  constexpr double kDeviation = 0.021;  // 0.3 of a round over the root of 8 rounds and of 30, the columns' squares
  for (size_t k = 0; k < 2; ++k) EXPECT_NEAR(polished.x[k], truth[k], 4 * kDeviation) << k;
  EXPECT_TRUE(polished.converged);
}

// A truth farther away than one step reaches is found by the next.
TEST(FitRounds, PolishGoesOnFromStepToStep) {
  NoisyPictures pictures(5, 2, 0.1);
  const std::vector<double> truth{0.87, 0.36};
  std::vector<uint32_t> numbers;
  int samples = 0;
  const Polished polished = polish(
      [&](std::span<const double> x, int spp, uint32_t number) {
        numbers.push_back(number);
        samples += spp;
        return pictures.round(x, truth);
      },
      kHere, 960, pictures.cells, [] { return false; }, [](std::span<const double>, double) {});
  EXPECT_GT(samples, 960);  // steps of 0.15 with an eighth of them
  EXPECT_LT(samples, 2 * 960);
  for (size_t i = 0; i < numbers.size(); ++i) EXPECT_EQ(numbers[i], i);
  for (size_t k = 0; k < 2; ++k) {
    ASSERT_TRUE(polished.errors.deviations[k]);
    EXPECT_NEAR(polished.x[k], truth[k], 4 * *polished.errors.deviations[k]);
  }
  EXPECT_TRUE(polished.converged);
}

// A polish without its last rounds has not come to rest, however short its steps were.
TEST(FitRounds, PolishThatIsCutHasNotConverged) {
  for (const int allowed : {8, 9, 16, 20, 23, 24}) {
    NoisyPictures pictures(6, 2, 0.1);
    int asked = 0;
    const Polished polished = polish(
        [&](std::span<const double> x, int, uint32_t) {
          ++asked;
          return pictures.round(x, kHere);
        },
        kHere, 960, pictures.cells, [&] { return asked >= allowed; }, [](std::span<const double>, double) {});
    EXPECT_EQ(polished.converged, allowed == 24) << allowed;  // three places of eight rounds
  }
}

TEST(FitRounds, PolishEndsEarlyWithWhatItHas) {
  NoisyPictures pictures(6, 2, 0.1);
  int asked = 0;
  const Polished polished = polish(
      [&](std::span<const double> x, int, uint32_t) {
        ++asked;
        return pictures.round(x, kTruth);
      },
      kHere, 960, pictures.cells, [] { return true; }, [](std::span<const double>, double) {});
  EXPECT_EQ(asked, 3);
  EXPECT_FALSE(polished.converged);
  EXPECT_EQ(polished.x.size(), 2u);
  EXPECT_EQ(polished.errors.deviations.size(), 2u);
}

}  // namespace
}  // namespace wale::fit
