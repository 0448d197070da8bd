#include "host/fit/least_squares.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "geom/error.h"

namespace wale::fit {
namespace {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

constexpr int kRefused = 4;  // steps in a row that lead nowhere: what is left is noise

Vector vector_of(const std::vector<double>& v) { return Eigen::Map<const Vector>(v.data(), Eigen::Index(v.size())); }

// J^T J and J^T r, of products of the two replicates where there are two.
struct Normal {
  Matrix h;
  Vector g;
};
Normal normal_of(const std::vector<Matrix>& j, const Residuals& at) {
  const Matrix &a = j.front(), &b = j.back();
  const Vector ra = vector_of(at.replicates.front().values), rb = vector_of(at.replicates.back().values);
  const Matrix h = a.transpose() * b;
  return {0.5 * (h + h.transpose()), 0.5 * (a.transpose() * rb + b.transpose() * ra)};
}

double largest_curvature(const Normal& n) { return n.h.diagonal().maxCoeff(); }

class Descent {
 public:
  Descent(const ResidualFunction& f, std::span<const double> start, const LeastSquaresOptions& options,
          const LeastSquaresProgress& progress)
      : f_(f), options_(options), progress_(progress), x_(start.begin(), start.end()) {}

  LeastSquaresResult run() {
    for (double& v : x_) v = std::clamp(v, 0.0, 1.0);
    at_ = evaluate(x_, true);
    report(x_, at_.loss(), true);
    take_derivatives();
    double damping = 1e-2 * first_scale(), growth = 2;
    int quiet = 0, refused = 0;
    bool converged = false;
    while (!spent() && !converged) {
      const Normal n = normal_of(j_, at_);
      const Vector step = bounded_step(n, damping);
      if (step.cwiseAbs().maxCoeff() < options_.least_step) {
        converged = fresh_ && (refused == 0 || largest_curvature(n) > 0);
        if (fresh_ || !refresh()) break;
        continue;
      }
      std::vector<double> to(x_.size());
      for (size_t k = 0; k < to.size(); ++k) to[k] = std::clamp(x_[k] + step[Eigen::Index(k)], 0.0, 1.0);
      Residuals there = evaluate(to, true);
      const double best = at_.loss(), loss = there.loss(), gained = best - loss;
      report(to, loss, gained > 0);
      if (!(gained > 0)) {
        // Derivatives that are estimates are to blame first, then the length of the step.
        if (!fresh_) {
          if (!refresh()) break;
          continue;
        }
        if (++refused == kRefused) {
          converged = largest_curvature(n) > 0;
          break;
        }
        damping *= growth;
        growth *= 2;
        continue;
      }
      refused = 0;
      const double expected = -step.dot(2 * n.g + n.h * step), quality = expected > 0 ? gained / expected : 0;
      damping *= std::clamp(1 - std::pow(2 * quality - 1, 3), 1.0 / 3, 2.0);
      growth = 2;
      take_step(step, to, std::move(there));
      quiet = gained < options_.least_gain * std::abs(best) ? quiet + 1 : 0;
      converged = quiet == 2;
    }
    return {x_, at_, evaluations_, converged};
  }

 private:
  // Of the curvature. Noise may leave products of replicates without any above 0; lengths of their columns bound it.
  double first_scale() const {
    double scale = largest_curvature(normal_of(j_, at_));
    if (!(scale > 0))
      for (Eigen::Index k = 0; k < Eigen::Index(x_.size()); ++k)
        scale = std::max(scale, j_.front().col(k).norm() * j_.back().col(k).norm());
    return std::max(scale, 1e-300);
  }

  bool spent() const { return evaluations_ >= options_.evaluations || options_.stop(); }

  Residuals evaluate(const std::vector<double>& x, bool derivatives) {
    ++evaluations_;
    Residuals r = f_(x, derivatives);
    if (r.replicates.empty() || r.replicates.size() > 2) bug("fit: {} replicates of residuals", r.replicates.size());
    if (!at_.replicates.empty() && (r.replicates.size() != at_.replicates.size() ||
                                    r.replicates[0].values.size() != at_.replicates[0].values.size()))
      bug("fit: the number of residuals changes");
    return r;
  }

  void report(const std::vector<double>& x, double loss, bool better) const {
    if (progress_) progress_(x, loss, better);
  }

  bool given(size_t k) const {
    const auto& derivatives = at_.replicates.front().derivatives;
    return k < derivatives.size() && !derivatives[k].empty();
  }

  // Columns that came with the residuals.
  void take_given() {
    for (size_t k = 0; k < x_.size(); ++k)
      for (size_t r = 0; given(k) && r < j_.size(); ++r)
        j_[r].col(Eigen::Index(k)) = vector_of(at_.replicates[r].derivatives[k]);
  }

  void take_derivatives() {
    j_.assign(at_.replicates.size(),
              Matrix::Zero(Eigen::Index(at_.replicates[0].values.size()), Eigen::Index(x_.size())));
    take_given();
    for (size_t k = 0; k < x_.size() && !options_.stop(); ++k) {
      if (given(k)) continue;
      std::vector<double> to = x_;
      const double step = x_[k] + options_.difference <= 1 ? options_.difference : -options_.difference;
      to[k] += step;
      const Residuals there = evaluate(to, false);
      report(to, there.loss(), false);
      for (size_t r = 0; r < j_.size(); ++r)
        j_[r].col(Eigen::Index(k)) =
            (vector_of(there.replicates[r].values) - vector_of(at_.replicates[r].values)) / step;
    }
    fresh_ = true;
  }

  // Anew where the descent stands; false when there is no time for it.
  bool refresh() {
    if (spent()) return false;
    take_derivatives();
    return true;
  }

  void take_step(const Vector& step, const std::vector<double>& to, Residuals there) {
    for (size_t r = 0; r < j_.size(); ++r) {
      const Vector change = vector_of(there.replicates[r].values) - vector_of(at_.replicates[r].values);
      j_[r] += (change - j_[r] * step) * step.transpose() / step.squaredNorm();
    }
    x_ = to;
    at_ = std::move(there);
    take_given();
    fresh_ = true;
    for (size_t k = 0; k < x_.size(); ++k) fresh_ = fresh_ && given(k);
  }

  // Axes at a bound that the step would leave are held there.
  Vector bounded_step(const Normal& normal, double damping) const {
    const Eigen::Index n = normal.g.size();
    std::vector<bool> held(size_t(n), false);
    Vector step = Vector::Zero(n);
    for (Eigen::Index round = 0; round <= n; ++round) {
      std::vector<Eigen::Index> open;
      for (Eigen::Index k = 0; k < n; ++k)
        if (!held[size_t(k)]) open.push_back(k);
      step.setZero();
      if (open.empty()) break;
      // Noise may leave a product of replicates without a positive definite curvature.
      const Eigen::SelfAdjointEigenSolver<Matrix> curvature(normal.h(open, open));
      const Vector down = curvature.eigenvectors().transpose() * -normal.g(open);
      const Vector s =
          curvature.eigenvectors() * (down.array() / (curvature.eigenvalues().array().max(0.0) + damping)).matrix();
      for (size_t i = 0; i < open.size(); ++i) step[open[i]] = s[Eigen::Index(i)];
      bool again = false;
      for (const Eigen::Index k : open) {
        const double x = x_[size_t(k)];
        if ((x <= 0 && step[k] < 0) || (x >= 1 && step[k] > 0)) held[size_t(k)] = again = true;
      }
      if (!again) break;
    }
    for (Eigen::Index k = 0; k < n; ++k) step[k] = std::clamp(x_[size_t(k)] + step[k], 0.0, 1.0) - x_[size_t(k)];
    return step;
  }

  const ResidualFunction& f_;
  const LeastSquaresOptions& options_;
  const LeastSquaresProgress& progress_;
  std::vector<double> x_;
  Residuals at_;
  std::vector<Matrix> j_;  ///< per replicate
  bool fresh_ = false;     ///< nothing of it is an estimate of Broyden's
  int evaluations_ = 0;
};

}  // namespace

double Residuals::loss() const {
  const std::vector<double>&a = replicates.front().values, &b = replicates.back().values;
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

LeastSquaresResult least_squares(const ResidualFunction& f, std::span<const double> start,
                                 const LeastSquaresOptions& options, const LeastSquaresProgress& progress) {
  return Descent(f, start, options, progress).run();
}

}  // namespace wale::fit
