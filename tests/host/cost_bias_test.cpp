// Bias of synthetic pictures whose bias and noise are known.
#include <cmath>
#include <random>

#include "host/cost/bias.h"
#include "tests/temporary_folder.h"
#include "tests/tolerances.h"

namespace wale::cost {
namespace {

constexpr int kSide = 20, kTrials = 500;

// Pictures whose expected values are known, with noise as a path tracer's: skewed, and nearly the same in R, G and B.
class Source {
 public:
  explicit Source(unsigned seed) : engine_(seed) {}

  Picture truth() const {
    Picture out{kSide, kSide, {}};
    for (int i = 0; i < kSide * kSide; ++i)
      for (const double tint : {1.0, 0.7, 0.3}) out.rgb.push_back(float(tint * (0.2 + 0.1 * std::sin(0.7 * i))));
    return out;
  }
  // Noise of relative size `noise` by an exponential distribution, a third of its variance apart per channel.
  Picture noisy(const Picture& mean, double noise) {
    Picture out = mean;
    for (size_t p = 0; p < mean.pixels(); ++p) {
      const double common = spread();
      for (size_t c = 0; c < 3; ++c)
        out.rgb[3 * p + c] *= float(1 + noise * (std::sqrt(2.0 / 3) * common + std::sqrt(1.0 / 3) * spread()));
    }
    return out;
  }
  std::vector<Picture> noisy(const Picture& mean, double noise, int count) {
    std::vector<Picture> out;
    for (int i = 0; i < count; ++i) out.push_back(noisy(mean, noise));
    return out;
  }

 private:
  double spread() { return -std::log((double(engine_()) + 0.5) * 0x1p-32) - 1; }  // mean 0, variance 1
  std::mt19937 engine_;
};

Picture times(Picture picture, double factor) {
  for (size_t i = 0; i < picture.rgb.size(); ++i) picture.rgb[i] *= float(i % 7 < 3 ? factor : 1);
  return picture;
}

double relative_mse(const Picture& a, const Picture& b, const std::vector<double>& weights) {
  double sum = 0;
  for (size_t i = 0; i < a.rgb.size(); ++i) sum += weights[i / 3] * std::pow(double(a.rgb[i]) - b.rgb[i], 2);
  return sum;
}

// Of kTrials, how often an event of this chance may come: four standard errors about its mean.
void expect_share(int count, double chance, const char* what) {
  const double mean = kTrials * chance, error = std::sqrt(mean * (1 - chance));
  EXPECT_NEAR(count, mean, tolerance::kStandardErrors * error) << what;
}

class CostBias : public testing::TestWithParam<double> {};
// Bias of half the pixels: none, one far below the noise of a picture, one above it.
INSTANTIATE_TEST_SUITE_P(Factors, CostBias, testing::Values(1.0, 1.05, 1.3));

TEST_P(CostBias, IntervalHoldsTheTruthAsOftenAsItSays) {
  Source source(7);
  const Picture reference = source.truth(), level = times(reference, GetParam());
  const std::vector<double> weights = relative_weights(reference);
  const double truth = relative_mse(level, reference, weights);
  int below = 0, above = 0, resolved = 0;
  double sum = 0, squares = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Bias b = relative_bias(source.noisy(level, 0.4, 6), source.noisy(reference, 0.2, 6), weights);
    below += b.high()<truth, above += b.low()> truth, resolved += b.resolved();
    sum += b.relative_mse, squares += b.relative_mse * b.relative_mse;
  }
  const double mean = sum / kTrials, error = std::sqrt((squares / kTrials - mean * mean) / kTrials);
  EXPECT_NEAR(mean, truth, tolerance::kStandardErrors * error);
  expect_share(below + above, 0.05, "outside of the interval");
  if (GetParam() == 1) expect_share(resolved, 0.025, "resolved though there is no bias");
  if (GetParam() == 1.3) {
    EXPECT_EQ(resolved, kTrials);
  }
}

// Weights from the noisy reference itself must not make a bias out of its noise.
TEST(CostBias, NoneIsFoundWhereThereIsNone) {
  Source source(8);
  const Picture truth = source.truth();
  int resolved = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const std::vector<Picture> reference = source.noisy(truth, 0.8, 4);
    resolved += relative_bias(source.noisy(truth, 0.8, 4), reference, relative_weights(mean_of(reference))).resolved();
  }
  expect_share(resolved, 0.025, "resolved though there is no bias");
}

TEST(CostBias, AGivenReferenceCountsWithItsNoise) {
  Source source(9);
  const Picture truth = source.truth(), level = times(truth, 1.05);
  const std::vector<double> weights = relative_weights(truth);
  const double noise = 0.1;
  std::vector<float> variance;
  for (const float v : truth.rgb) variance.push_back(float(noise * noise * v * v));
  const double bias = relative_mse(level, truth, weights);
  int outside = 0, resolved = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Picture reference = source.noisy(truth, noise);
    const Bias b = relative_bias(source.noisy(level, 0.3, 6), reference, variance, weights);
    outside += b.high() < bias || b.low() > bias;
    resolved += relative_bias(source.noisy(truth, 0.3, 6), reference, variance, weights).resolved();
  }
  // Channels count as if their noise were the same, so that intervals are wider than they need be.
  EXPECT_LT(outside, 0.05 * kTrials + tolerance::kStandardErrors * std::sqrt(0.05 * kTrials));
  EXPECT_LT(resolved, 0.025 * kTrials + tolerance::kStandardErrors * std::sqrt(0.025 * kTrials));
}

// Repetitions of one seed have noise in common, which leaves the difference.
TEST(CostBias, CommonNoiseCancels) {
  Source source(10);
  const Picture truth = source.truth(), level = times(truth, 1.05);
  const std::vector<double> weights = relative_weights(truth);
  std::vector<Picture> reference = source.noisy(truth, 0.4, 6), same, other = source.noisy(level, 0.4, 6);
  for (const Picture& picture : reference) same.push_back(times(picture, 1.05));
  const Bias paired = relative_bias(same, reference, weights), apart = relative_bias(other, reference, weights);
  EXPECT_LT(paired.standard_error, 0.2 * apart.standard_error);
  EXPECT_TRUE(paired.resolved());
  EXPECT_NEAR(paired.relative_mse, relative_mse(level, truth, weights), 4 * paired.standard_error);
}

TEST(CostBias, TooFewRepetitionsSayNothing) {
  Source source(11);
  const Picture truth = source.truth();
  const std::vector<double> weights = relative_weights(truth);
  const std::vector<Picture> some = source.noisy(truth, 0.1, 3);
  const Bias b = relative_bias(source.noisy(times(truth, 2), 0.1, 3), some, weights);
  EXPECT_FALSE(b.known());
  EXPECT_FALSE(b.resolved());
  EXPECT_EQ(b.repetitions, 3);
}

TEST(CostBias, TheSamePicturesHaveNone) {
  Source source(12);
  const std::vector<Picture> same = source.noisy(source.truth(), 0.3, 5);
  const Bias b = relative_bias(same, same, relative_weights(mean_of(same)));
  EXPECT_EQ(b.relative_mse, 0);
  EXPECT_EQ(b.standard_error, 0);
  EXPECT_TRUE(b.resolved());
}

TEST(CostBias, WeightsAreOfTheNeighbours) {
  Picture picture{5, 5, std::vector<float>(75, 1.0f)};
  picture.rgb[3 * 12] = picture.rgb[3 * 12 + 1] = picture.rgb[3 * 12 + 2] = 100;  // the middle
  const std::vector<double> weights = relative_weights(picture);
  const double mean = (24 + 100) / 25.0, least = 0.01 * mean * mean;
  EXPECT_NEAR(weights[12], 1 / (1 + least) / 75, 1e-12);
  EXPECT_NEAR(weights[0], 1 / (1 + least) / 75, 1e-12);                       // a corner, far from it
  EXPECT_NEAR(weights[7], 1 / (std::pow(107 / 8.0, 2) + least) / 75, 1e-12);  // beside it
}

// A difference that one repetition alone shows says nothing of its size, and is not none.
TEST(CostBias, ADifferenceInOneRepetitionIsNeitherNoneNorResolved) {
  const Picture flat{4, 4, std::vector<float>(48, 0.5f)};
  const std::vector<Picture> reference(8, flat);
  std::vector<Picture> level = reference;
  const std::vector<double> weights = relative_weights(flat);
  EXPECT_TRUE(relative_bias(level, reference, weights).same);
  EXPECT_TRUE(relative_bias(level, reference, weights).resolved());
  level[3].rgb[15] = 40;
  const Bias rare = relative_bias(level, reference, weights);
  EXPECT_FALSE(rare.same);
  EXPECT_FALSE(rare.known());
  EXPECT_FALSE(rare.resolved());
}

}  // namespace
}  // namespace wale::cost
