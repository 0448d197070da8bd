#pragma once
#include <Eigen/Dense>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "host/fit/least_squares.h"

namespace wale::fit {

/// How well residuals determine each axis of the box.
struct ParameterErrors {
  /// Standard deviations. No value where the pictures say hardly anything.
  std::vector<std::optional<double>> deviations;
  std::vector<std::vector<double>> correlation;
  bool too_few_cells = false;  ///< to tell any of it: no axis has a deviation, no two are correlated

  /// Pairs of axes whose correlation is larger than that, of either sign.
  std::vector<std::pair<size_t, size_t>> alike(double correlation) const;
};

/// Residuals of one place of the box, rendered several times with noise that is independent from round to round.
///
/// What a least-squares step takes are products: of derivatives with residuals, and with derivatives. Noise in both
/// factors adds to them, more than the truth where light has scattered many times. So only factors of different rounds
/// are multiplied, each with each, which leaves the expectation of products without noise (a U-statistic: Hoeffding,
/// Annals of Mathematical Statistics 19, 1948), and as many samples count as all rounds have together.
class Rounds {
 public:
  /// `cells`: of each residual, which part of the pictures it is from; parts vary independently of each other.
  explicit Rounds(std::span<const int> cells);

  /// With all derivatives.
  void add(const Replicate& round);
  int count() const { return count_; }
  /// Sum of squared residuals without the rounds' noise; from two rounds on.
  double loss() const;

  struct Step {
    std::vector<double> x;   ///< where the residuals' squares are least, as far as the lines tell
    double loss = 0;         ///< expected there
    ParameterErrors errors;  ///< of x
  };
  /// From `x`, where the rounds were rendered, at most `reach` along each axis and within the box. From two rounds on.
  ///
  /// Derivatives g of the loss are sums over cells, and their covariance M is taken from how cells differ: so noise of
  /// photographs, of renders and what the model cannot do all count, neighbouring residuals that err together too
  /// (White, Econometrica 48, 1980, in clusters). With curvature A the place has the information A M^-1 A. A weak
  /// prior, one box wide, keeps axes that say nothing where they are.
  ///
  /// M of fewer cells than axes + 1 has not the rank: it would call certain what no cells could differ in. Then the
  /// step is Marquardt's damped one, and no errors are stated.
  Step solve(std::span<const double> x, double reach) const;

 private:
  struct Cell {
    Eigen::MatrixXd curvature;  ///< A, over pairs of rounds
    Eigen::VectorXd slope;      ///< half the derivative of the loss
  };
  std::vector<Cell> cells() const;

  std::vector<int> cell_of_;
  int cell_count_ = 0, count_ = 0;
  Eigen::VectorXd values_;       ///< summed over rounds
  Eigen::MatrixXd derivatives_;  ///< the same, column by column
  std::vector<Cell> own_;        ///< products within rounds, by cell
  double own_squares_ = 0;
};

}  // namespace wale::fit
