#pragma once
#include <functional>
#include <span>
#include <vector>

namespace wale::fit {

/// Residuals at a point of the unit box, and their derivatives along its axes where they are had at less than the price
/// of differences (column k of `derivatives` belongs to axis k; an empty column: not known).
struct Replicate {
  std::vector<double> values;
  std::vector<std::vector<double>> derivatives{};
};

/// One replicate, or two that are alike but for their noise, independent of each other. What noise adds to a sum of
/// squares depends on where it is taken, so that the least sum is where noise is least; a sum of products of two
/// replicates has the expectation of the squares without noise, and so have products of their derivatives.
struct Residuals {
  std::vector<Replicate> replicates;

  /// Sum of squares, or of products; then it may be a little below 0.
  double loss() const;
};

struct LeastSquaresOptions {
  int evaluations = 200;     ///< at most
  double difference = 0.03;  ///< step of differences
  double least_step = 2e-3;  ///< converged when every axis moves less
  double least_gain = 1e-3;  ///< converged when two steps in a row gain less of the loss
  std::function<bool()> stop = [] { return false; };
};

struct LeastSquaresResult {
  std::vector<double> x;
  Residuals residuals;  ///< there
  int evaluations = 0;
  bool converged = false;
};

/// Residuals at x; `derivatives`: those that are cheap are wanted too.
using ResidualFunction = std::function<Residuals(std::span<const double> x, bool derivatives)>;

/// Told about every evaluation; the best so far when `better`.
using LeastSquaresProgress = std::function<void(std::span<const double> x, double loss, bool better)>;

/// Least sum of squared residuals over the unit box: Levenberg-Marquardt (Marquardt 1963) with Nielsen's damping
/// (Madsen, Nielsen, Tingleff, Methods for Non-linear Least Squares Problems 2004, section 3.2) and an active set of
/// bounds. Four steps in a row that gain nothing end it: converged, unless noise of replicates left no curvature, so
/// that steps were blind. Derivatives that the function does not give are one-sided differences, brought up to date
/// between by Broyden's rank-one formula (1965).
LeastSquaresResult least_squares(const ResidualFunction& f, std::span<const double> start,
                                 const LeastSquaresOptions& options = {}, const LeastSquaresProgress& progress = {});

}  // namespace wale::fit
