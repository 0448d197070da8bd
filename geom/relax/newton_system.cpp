#include "geom/relax/newton_system.h"

#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <algorithm>

namespace wale {
namespace {

using Matrix = Eigen::SparseMatrix<double>;  // lower triangle
using Vector = Eigen::VectorXd;

Vector flat(const std::vector<dvec3>& v) {
  Vector out(long(3 * v.size()));
  for (size_t i = 0; i < v.size(); ++i)
    for (int a = 0; a < 3; ++a) out[long(3 * i) + a] = v[i][a];
  return out;
}

}  // namespace

struct NewtonSystem::Factors {
  Matrix hessian, damped;
  Eigen::SimplicialLLT<Matrix> solver;
  bool analysed = false;
};

NewtonSystem::NewtonSystem(size_t points) : count_(points), rows_(points), factors_(std::make_unique<Factors>()) {}
NewtonSystem::~NewtonSystem() = default;

bool NewtonSystem::has(uint32_t row, uint32_t column) const {
  return std::binary_search(rows_[column].begin(), rows_[column].end(), row);
}

void NewtonSystem::begin(const std::vector<LocalTerm>& terms, const std::vector<std::array<uint32_t, 4>>& spare) {
  const auto placed = [&](const LocalTerm& term) {
    for (int p = 0; p < term.count; ++p)
      for (int q = 0; q <= p; ++q)
        if (!has(std::max(term.point[p], term.point[q]), std::min(term.point[p], term.point[q]))) return false;
    return true;
  };
  if (!std::all_of(terms.begin(), terms.end(), placed)) rebuild(terms, spare);
  std::fill_n(factors_->hessian.valuePtr(), factors_->hessian.nonZeros(), 0.0);
  gradient_.assign(count_, dvec3(0.0));
  strain_gradient_ = dvec2(0.0);
  for (auto& border : border_) border.assign(count_, dvec3(0.0));
  std::fill_n(strain_hessian_, 3, 0.0);
}

void NewtonSystem::rebuild(const std::vector<LocalTerm>& terms, const std::vector<std::array<uint32_t, 4>>& spare) {
  for (auto& column : rows_) column.clear();
  for (uint32_t i = 0; i < count_; ++i) rows_[i].push_back(i);
  const auto place = [&](const auto& point, int count) {
    for (int p = 0; p < count; ++p)
      for (int q = 0; q < p; ++q) rows_[std::min(point[p], point[q])].push_back(std::max(point[p], point[q]));
  };
  for (const LocalTerm& term : terms) place(term.point, term.count);
  for (const auto& group : spare) place(group, 4);
  size_t blocks = 0;
  for (auto& rows : rows_) {
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    blocks += rows.size();
  }
  Matrix& hessian = factors_->hessian;
  hessian.resize(long(3 * count_), long(3 * count_));
  hessian.resizeNonZeros(long(9 * blocks - 3 * count_));
  int at = 0;
  for (size_t c = 0; c < count_; ++c)
    for (int a = 0; a < 3; ++a) {
      hessian.outerIndexPtr()[3 * c + size_t(a)] = at;
      for (const uint32_t r : rows_[c])
        for (int b = r == c ? a : 0; b < 3; ++b) hessian.innerIndexPtr()[at++] = int(3 * r) + b;
    }
  hessian.outerIndexPtr()[3 * count_] = at;
  factors_->analysed = false;
}

void NewtonSystem::add(const LocalTerm& term) {
  Matrix& hessian = factors_->hessian;
  for (int p = 0; p < term.count; ++p) {
    const uint32_t i = term.point[p];
    gradient_[i] += term.gradient[p];
    for (int k = 0; k < 2; ++k) border_[k][i] += term.border[p][k];
    for (int q = 0; q <= p; ++q) {
      const uint32_t j = term.point[q], row = std::max(i, j), column = std::min(i, j);
      // hessian[p][q] has rows of p and columns of q; two points of a term may be the same one of other tiles.
      const bool turned = j > i, twice = i == j && p != q;
      const auto place = std::lower_bound(rows_[column].begin(), rows_[column].end(), row) - rows_[column].begin();
      for (int a = 0; a < 3; ++a) {
        double* values = hessian.valuePtr() + hessian.outerIndexPtr()[3 * column + uint32_t(a)] + 3 * place - a;
        for (int b = row == column ? a : 0; b < 3; ++b) {
          const dmat3& h = term.hessian[p][q];
          values[b] += (turned ? h[b][a] : h[a][b]) + (twice ? h[b][a] : 0.0);
        }
      }
    }
  }
  strain_gradient_ += term.strain_gradient;
  for (int k = 0; k < 3; ++k) strain_hessian_[k] += term.strain_hessian[k];
}

std::optional<TileStep> NewtonSystem::solve(double damping, bool free_x, bool free_y) {
  Factors& f = *factors_;
  if (!f.analysed) f.damped = f.hessian;
  std::copy_n(f.hessian.valuePtr(), f.hessian.nonZeros(), f.damped.valuePtr());
  // The diagonal comes first in each column.
  for (long c = 0; c < f.damped.cols(); ++c) f.damped.valuePtr()[f.damped.outerIndexPtr()[c]] += damping;
  if (!f.analysed) f.solver.analyzePattern(f.damped);
  f.analysed = true;
  f.solver.factorize(f.damped);
  if (f.solver.info() != Eigen::Success) return std::nullopt;
  // Bordered by the free strains e: H u + B e = -g, B^T u + C e = -s.
  Vector u = f.solver.solve(-flat(gradient_));
  std::vector<int> free;
  if (free_x) free.push_back(0);
  if (free_y) free.push_back(1);
  TileStep step;
  if (!free.empty()) {
    const long n = long(free.size());
    Eigen::MatrixXd border(u.size(), n), schur(n, n);
    Vector right(n);
    for (long k = 0; k < n; ++k) border.col(k) = flat(border_[free[size_t(k)]]);
    const Eigen::MatrixXd solved = f.solver.solve(border);
    for (long k = 0; k < n; ++k) {
      right[k] = -strain_gradient_[free[size_t(k)]];
      for (long l = 0; l < n; ++l) schur(k, l) = strain_hessian_[free[size_t(k)] + free[size_t(l)]];
    }
    schur -= border.transpose() * solved;
    right -= border.transpose() * u;
    const Eigen::LLT<Eigen::MatrixXd> small(schur);
    if (small.info() != Eigen::Success) return std::nullopt;
    const Vector e = small.solve(right);
    u -= solved * e;
    for (long k = 0; k < n; ++k) step.strain[free[size_t(k)]] = e[k];
  }
  step.points.resize(count_);
  for (size_t i = 0; i < count_; ++i) step.points[i] = {u[long(3 * i)], u[long(3 * i) + 1], u[long(3 * i) + 2]};
  return step;
}

double NewtonSystem::model(const TileStep& step) const {
  const Vector u = flat(step.points);
  const Vector hu = factors_->hessian.selfadjointView<Eigen::Lower>() * u;
  const dvec2 e = step.strain;
  double linear = u.dot(flat(gradient_)) + glm::dot(e, strain_gradient_), quadratic = u.dot(hu);
  for (int k = 0; k < 2; ++k) quadratic += 2 * e[k] * u.dot(flat(border_[k]));
  quadratic += e.x * e.x * strain_hessian_[0] + 2 * e.x * e.y * strain_hessian_[1] + e.y * e.y * strain_hessian_[2];
  return linear + 0.5 * quadratic;
}

}  // namespace wale
