#pragma once
#include <span>
#include <vector>

namespace wale::cost {

/// R, G, B of every pixel, rows from the top; linear.
struct Picture {
  int width = 0, height = 0;
  std::vector<float> rgb;
  size_t pixels() const { return size_t(width) * size_t(height); }
};

/// Mean of pictures of one size.
Picture mean_of(std::span<const Picture> pictures);

/// What a squared error of each pixel counts in relative figures: 1 / (m^2 + e) / (3 pixels), with m the mean of the
/// pixel's eight neighbours in the reference, over R, G and B, and e a hundredth of the picture's mean squared. The
/// pixel itself is left out of m, so that its weight and its noise are independent of each other.
std::vector<double> relative_weights(const Picture& reference);

constexpr int kFewestRepetitions = 4;
constexpr size_t kMostCrossed = 64;  ///< later ones are left out

/// How far the expected pictures of a level and of the reference are apart.
struct Bias {
  double relative_mse = 0;    ///< unbiased estimate, so that it may be below 0
  double standard_error = 0;  ///< of it, by the noise of the pictures
  int repetitions = 0;        ///< that were crossed; below kFewestRepetitions there is no standard error
  bool same = false;          ///< every value of every repetition is that of the reference

  static constexpr double kQuantile = 1.96;  ///< 95 % of a normal distribution: a sum over thousands of pixels
  double low() const { return relative_mse - kQuantile * standard_error; }
  double high() const { return relative_mse + kQuantile * standard_error; }
  /// Upper limit of what cannot be below 0, where it is not resolved.
  double limit() const { return (relative_mse > 0 ? relative_mse : 0) + kQuantile * standard_error; }
  /// There is an interval: enough repetitions, and a difference in more of them than so few that no variance shows (the
  /// unbiased estimate of it is then 0 or less).
  bool known() const { return repetitions >= kFewestRepetitions && (same || standard_error > 0); }
  /// The interval does not hold 0, or the pictures are the same.
  bool resolved() const { return known() && (low() > 0 || same); }
};

/// Crosses repetitions: with d_i the difference of repetition i of the level from repetition i of the reference, the
/// mean of d_i d_j over i != j has the squared bias as its expectation, whatever the noise, since repetitions are
/// independent; those of one number may share their seed, so that common noise cancels in d_i. Its variance over the
/// noise, 4 D'CD/n + 2 tr(C^2)/(n(n-1)) a pixel for a bias D and covariance C of d (a U-statistic: Hoeffding 1948, "A
/// Class of Statistics with Asymptotically Normal Distribution"), is estimated without bias for any
/// distribution. Pixels are independent; channels need not be.
Bias relative_bias(std::span<const Picture> level, std::span<const Picture> reference,
                   const std::vector<double>& weights);

/// The same against one picture with the known variance of each of its values.
Bias relative_bias(std::span<const Picture> level, const Picture& reference, const std::vector<float>& variance,
                   const std::vector<double>& weights);

}  // namespace wale::cost
