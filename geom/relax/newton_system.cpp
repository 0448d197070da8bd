#include "geom/relax/newton_system.h"

#include <Eigen/Dense>
#include <algorithm>

namespace wale {
namespace {

using Vector = Eigen::VectorXd;

Vector flat(const std::vector<dvec3>& v) {
  Vector out(long(3 * v.size()));
  for (size_t i = 0; i < v.size(); ++i)
    for (int a = 0; a < 3; ++a) out[long(3 * i) + a] = v[i][a];
  return out;
}

}  // namespace

NewtonSystem::NewtonSystem(size_t points) : count_(points) { hessian_.start.assign(points + 1, 0); }

bool NewtonSystem::has(uint32_t row, uint32_t column) const {
  return std::binary_search(hessian_.row.begin() + hessian_.start[column],
                            hessian_.row.begin() + hessian_.start[column + 1], row);
}

void NewtonSystem::begin(const std::vector<LocalTerm>& terms, const std::vector<std::array<uint32_t, 4>>& spare) {
  const auto placed = [&](const LocalTerm& term) {
    for (int p = 0; p < term.count; ++p)
      for (int q = 0; q <= p; ++q)
        if (!has(std::max(term.point[p], term.point[q]), std::min(term.point[p], term.point[q]))) return false;
    return true;
  };
  if (!std::all_of(terms.begin(), terms.end(), placed)) rebuild(terms, spare);
  hessian_.block.assign(hessian_.row.size(), dmat3(0.0));
  gradient_.assign(count_, dvec3(0.0));
  strain_gradient_ = dvec2(0.0);
  for (auto& border : border_) border.assign(count_, dvec3(0.0));
  std::fill_n(strain_hessian_, 3, 0.0);
}

void NewtonSystem::rebuild(const std::vector<LocalTerm>& terms, const std::vector<std::array<uint32_t, 4>>& spare) {
  std::vector<std::vector<uint32_t>> columns(count_);
  for (uint32_t i = 0; i < count_; ++i) columns[i].push_back(i);
  const auto place = [&](const auto& point, int count) {
    for (int p = 0; p < count; ++p)
      for (int q = 0; q < p; ++q) columns[std::min(point[p], point[q])].push_back(std::max(point[p], point[q]));
  };
  for (const LocalTerm& term : terms) place(term.point, term.count);
  for (const auto& group : spare) place(group, 4);
  hessian_.row.clear();
  for (size_t c = 0; c < count_; ++c) {
    std::sort(columns[c].begin(), columns[c].end());
    columns[c].erase(std::unique(columns[c].begin(), columns[c].end()), columns[c].end());
    hessian_.row.insert(hessian_.row.end(), columns[c].begin(), columns[c].end());
    hessian_.start[c + 1] = uint32_t(hessian_.row.size());
  }
  factors_.analyse(hessian_);
}

void NewtonSystem::add(const LocalTerm& term) {
  for (int p = 0; p < term.count; ++p) {
    const uint32_t i = term.point[p];
    gradient_[i] += term.gradient[p];
    for (int k = 0; k < 2; ++k) border_[k][i] += term.border[p][k];
    for (int q = 0; q <= p; ++q) {
      // hessian[p][q] has rows of p and columns of q; two points of a term may be the same one of other tiles.
      const uint32_t j = term.point[q], row = std::max(i, j), column = std::min(i, j);
      const auto first = hessian_.row.begin() + hessian_.start[column],
                 end = hessian_.row.begin() + hessian_.start[column + 1];
      dmat3& block = hessian_.block[size_t(std::lower_bound(first, end, row) - hessian_.row.begin())];
      const dmat3& h = term.hessian[p][q];
      if (j <= i) block += h;
      if (j > i || (i == j && p != q)) block += glm::transpose(h);
    }
  }
  strain_gradient_ += term.strain_gradient;
  for (int k = 0; k < 3; ++k) strain_hessian_[k] += term.strain_hessian[k];
}

std::optional<TileStep> NewtonSystem::solve(double damping, bool free_x, bool free_y,
                                            const std::function<bool()>& over) {
  if (!factors_.factorise(hessian_, damping, over)) return std::nullopt;
  // Bordered by the free strains e: H u + B e = -g, B^T u + C e = -s.
  std::vector<int> free;
  if (free_x) free.push_back(0);
  if (free_y) free.push_back(1);
  Eigen::MatrixXd solved(long(3 * count_), long(1 + free.size()));
  solved.col(0) = -flat(gradient_);
  for (size_t k = 0; k < free.size(); ++k) solved.col(long(k) + 1) = flat(border_[free[k]]);
  const Eigen::MatrixXd border = solved.rightCols(long(free.size()));
  factors_.solve({solved.data(), size_t(solved.size())});
  Vector u = solved.col(0);
  TileStep step;
  if (!free.empty()) {
    const long n = long(free.size());
    Eigen::MatrixXd schur(n, n);
    Vector right(n);
    for (long k = 0; k < n; ++k) {
      right[k] = -strain_gradient_[free[size_t(k)]];
      for (long l = 0; l < n; ++l) schur(k, l) = strain_hessian_[free[size_t(k)] + free[size_t(l)]];
    }
    schur -= border.transpose() * solved.rightCols(n);
    right -= border.transpose() * u;
    const Eigen::LLT<Eigen::MatrixXd> small(schur);
    if (small.info() != Eigen::Success) return std::nullopt;
    const Vector e = small.solve(right);
    u -= solved.rightCols(n) * e;
    for (long k = 0; k < n; ++k) step.strain[free[size_t(k)]] = e[k];
  }
  step.points.resize(count_);
  for (size_t i = 0; i < count_; ++i) step.points[i] = {u[long(3 * i)], u[long(3 * i) + 1], u[long(3 * i) + 2]};
  return step;
}

double NewtonSystem::model(const TileStep& step) const {
  const Vector u = flat(step.points);
  const dvec2 e = step.strain;
  double linear = u.dot(flat(gradient_)) + glm::dot(e, strain_gradient_), quadratic = 0;
  for (size_t c = 0; c < count_; ++c)
    for (uint32_t k = hessian_.start[c]; k < hessian_.start[c + 1]; ++k)
      quadratic +=
          (hessian_.row[k] == c ? 1 : 2) * glm::dot(step.points[hessian_.row[k]], hessian_.block[k] * step.points[c]);
  for (int k = 0; k < 2; ++k) quadratic += 2 * e[k] * u.dot(flat(border_[k]));
  quadratic += e.x * e.x * strain_hessian_[0] + 2 * e.x * e.y * strain_hessian_[1] + e.y * e.y * strain_hessian_[2];
  return linear + 0.5 * quadratic;
}

}  // namespace wale
