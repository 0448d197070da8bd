#include "host/fit/rounds.h"

#include <algorithm>
#include <cmath>

#include "geom/error.h"

namespace wale::fit {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr double kOwn = 0.1;          // share of a covariance that is taken to be each axis' own: cells are few
constexpr double kSaysNothing = 0.8;  // of the box, deviation with the prior alone: 1
constexpr double kDamping = 1e-2;     // of the largest curvature

Matrix inverse(const Matrix& m) {
  const Eigen::SelfAdjointEigenSolver<Matrix> e(m);
  const Vector v = e.eigenvalues();
  const double least = std::max(1e-12 * v.maxCoeff(), 1e-300);  // has a reciprocal
  return e.eigenvectors() * v.cwiseMax(least).cwiseInverse().asDiagonal() * e.eigenvectors().transpose();
}

// Noise may leave products of rounds without a positive curvature somewhere; there the pictures say nothing.
Matrix positive(const Matrix& a) {
  const Eigen::SelfAdjointEigenSolver<Matrix> e(0.5 * (a + a.transpose()));
  return e.eigenvectors() * e.eigenvalues().cwiseMax(0.0).asDiagonal() * e.eigenvectors().transpose();
}

}  // namespace

std::vector<std::pair<size_t, size_t>> ParameterErrors::alike(double least) const {
  std::vector<std::pair<size_t, size_t>> pairs;
  for (size_t a = 0; a < correlation.size(); ++a)
    for (size_t b = a + 1; b < correlation.size(); ++b)
      if (std::abs(correlation[a][b]) > least) pairs.emplace_back(a, b);
  return pairs;
}

Rounds::Rounds(std::span<const int> cells) : cell_of_(cells.begin(), cells.end()) {
  for (const int c : cells) cell_count_ = std::max(cell_count_, c + 1);
}

void Rounds::add(const Replicate& round) {
  const auto n = Eigen::Index(cell_of_.size()), axes = Eigen::Index(round.derivatives.size());
  if (round.values.size() != cell_of_.size()) bug("Rounds: {} residuals for {} cells", round.values.size(), n);
  if (count_++ == 0) {
    values_ = Vector::Zero(n);
    derivatives_ = Matrix::Zero(n, axes);
    own_.assign(size_t(cell_count_), {Matrix::Zero(axes, axes), Vector::Zero(axes)});
  }
  if (derivatives_.cols() != axes) bug("Rounds: the number of axes changes");
  Vector j(axes);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double value = round.values[size_t(i)];
    for (Eigen::Index k = 0; k < axes; ++k) j[k] = round.derivatives[size_t(k)][size_t(i)];
    values_[i] += value;
    derivatives_.row(i) += j.transpose();
    Cell& own = own_[size_t(cell_of_[size_t(i)])];
    own.curvature += j * j.transpose();
    own.slope += j * value;
    own_squares_ += value * value;
  }
}

double Rounds::loss() const {
  if (count_ < 2) bug("Rounds: {} of them make no pair", count_);
  return (values_.squaredNorm() - own_squares_) / (double(count_) * (count_ - 1));
}

std::vector<Rounds::Cell> Rounds::cells() const {
  const Eigen::Index axes = derivatives_.cols();
  std::vector<Cell> out(size_t(cell_count_), {Matrix::Zero(axes, axes), Vector::Zero(axes)});
  for (Eigen::Index i = 0; i < values_.size(); ++i) {
    Cell& cell = out[size_t(cell_of_[size_t(i)])];
    const Vector j = derivatives_.row(i);
    cell.curvature += j * j.transpose();
    cell.slope += j * values_[i];
  }
  const double pairs = double(count_) * (count_ - 1);
  for (size_t c = 0; c < out.size(); ++c) {
    out[c].curvature = (out[c].curvature - own_[c].curvature) / pairs;
    out[c].slope = (out[c].slope - own_[c].slope) / pairs;
  }
  return out;
}

Rounds::Step Rounds::solve(std::span<const double> x, double reach) const {
  const double loss_here = loss();
  const std::vector<Cell> cells = this->cells();
  const auto axes = Eigen::Index(x.size());
  Matrix a = Matrix::Zero(axes, axes);
  Vector b = Vector::Zero(axes);
  for (const Cell& cell : cells) a += cell.curvature, b += cell.slope;
  a = positive(a);
  const bool too_few = cells.size() < x.size() + 1;
  const double damping = kDamping * a.diagonal().maxCoeff();

  const auto covariance = [&](const Vector& step) {
    Matrix m = Matrix::Zero(axes, axes);
    Vector mean = Vector::Zero(axes);
    for (const Cell& cell : cells) mean += (cell.slope + cell.curvature * step) / double(cells.size());
    for (const Cell& cell : cells) {
      const Vector d = cell.slope + cell.curvature * step - mean;
      m += d * d.transpose();
    }
    m *= double(cells.size()) / std::max(1.0, double(cells.size()) - 1);
    const Matrix own = m.diagonal().asDiagonal();
    return Matrix((1 - kOwn) * m + kOwn * own);
  };
  const auto information = [](const Matrix& curvature, const Matrix& m) {
    return Matrix(curvature * inverse(m) * curvature + Matrix::Identity(m.rows(), m.cols()));
  };
  const auto free_step = [&](const Matrix& curvature, const Vector& slope, const Matrix& m) -> Vector {
    if (!too_few) return inverse(information(curvature, m)) * (curvature * (inverse(m) * -slope));
    if (!(damping > 0)) return Vector::Zero(slope.size());
    return inverse(curvature + damping * Matrix::Identity(m.rows(), m.cols())) * -slope;
  };

  Vector lower(axes), upper(axes), step = Vector::Zero(axes);
  for (Eigen::Index k = 0; k < axes; ++k) {
    lower[k] = std::max(-reach, -x[size_t(k)]);
    upper[k] = std::min(reach, 1 - x[size_t(k)]);
  }
  // The covariance at the end of the step is wanted; it hardly changes.
  for (int again = 0; again < 3; ++again) {
    const Matrix m = covariance(step);
    std::vector<Eigen::Index> open;
    for (Eigen::Index k = 0; k < axes; ++k) open.push_back(k);
    step.setZero();
    while (!open.empty()) {
      // The equations of axes that are held at an end do not hold.
      for (const Eigen::Index k : open) step[k] = 0;
      const Vector slope = b + a * step;
      const Vector s = free_step(a(open, open), slope(open), m(open, open));
      // Of those that go too far, the one that does most is held; without it the others may not.
      size_t worst = open.size();
      double most = 0;
      for (size_t i = 0; i < open.size(); ++i) {
        const double v = std::isfinite(s[Eigen::Index(i)]) ? s[Eigen::Index(i)] : 0;  // else it says nothing
        step[open[i]] = std::clamp(v, lower[open[i]], upper[open[i]]);
        if (const double beyond = std::abs(v - step[open[i]]); beyond > most) most = beyond, worst = i;
      }
      if (worst == open.size()) break;
      open.erase(open.begin() + std::ptrdiff_t(worst));
    }
  }

  Step out;
  out.x.resize(x.size());
  for (Eigen::Index k = 0; k < axes; ++k) out.x[size_t(k)] = std::clamp(x[size_t(k)] + step[k], 0.0, 1.0);
  out.loss = loss_here + step.dot(2 * b + a * step);
  out.errors.deviations.resize(x.size());
  out.errors.correlation.assign(x.size(), std::vector<double>(x.size(), 0.0));
  out.errors.too_few_cells = too_few;
  if (too_few) return out;
  const Matrix spread = inverse(information(a, covariance(step)));
  for (Eigen::Index k = 0; k < axes; ++k) {
    const double deviation = std::sqrt(spread(k, k));
    if (deviation < kSaysNothing) out.errors.deviations[size_t(k)] = deviation;
    for (Eigen::Index i = 0; i < axes; ++i)
      out.errors.correlation[size_t(k)][size_t(i)] = spread(k, i) / std::sqrt(spread(k, k) * spread(i, i));
  }
  return out;
}

}  // namespace wale::fit
