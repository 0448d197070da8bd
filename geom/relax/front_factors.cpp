#include "geom/relax/front_factors.h"

#include <Eigen/Dense>
#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>

namespace wale {
namespace {

using Matrix = Eigen::MatrixXd;
using Map = Eigen::Map<Matrix>;
using ConstMap = Eigen::Map<const Matrix>;

constexpr uint32_t kNone = ~0u;
// Rows of a dense matrix: from kAsked on it is worth asking whether to go on, up to kWhole it takes a second or two.
constexpr long kAsked = 600, kWhole = 3000, kPanel = 256;

// Fill-reducing order of the columns: [column] -> place.
std::vector<uint32_t> minimum_degree(const BlockMatrix& matrix) {
  const int n = int(matrix.columns());
  std::vector<Eigen::Triplet<char, int>> entries;
  for (int c = 0; c < n; ++c)
    for (uint32_t k = matrix.start[size_t(c)]; k < matrix.start[size_t(c) + 1]; ++k) {
      entries.emplace_back(int(matrix.row[k]), c, char(1));
      if (int(matrix.row[k]) != c) entries.emplace_back(c, int(matrix.row[k]), char(1));
    }
  Eigen::SparseMatrix<char, Eigen::ColMajor, int> graph(n, n);
  graph.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Eigen::AMDOrdering<int>()(graph, order);
  std::vector<uint32_t> place(static_cast<size_t>(n));
  for (int i = 0; i < n; ++i) place[size_t(order.indices()[i])] = uint32_t(i);
  return place;
}

// Rows below the diagonal of each column of the factors, ascending.
std::vector<std::vector<uint32_t>> structure(const BlockMatrix& matrix, const std::vector<uint32_t>& place) {
  std::vector<std::vector<uint32_t>> below(place.size());
  for (uint32_t c = 0; c < place.size(); ++c)
    for (uint32_t k = matrix.start[c] + 1; k < matrix.start[c + 1]; ++k) {
      const uint32_t a = place[c], b = place[matrix.row[k]];
      below[std::min(a, b)].push_back(std::max(a, b));
    }
  for (uint32_t c = 0; c < place.size(); ++c) {
    std::sort(below[c].begin(), below[c].end());
    below[c].erase(std::unique(below[c].begin(), below[c].end()), below[c].end());
    // Its parent is the first of them, and takes over the others.
    if (below[c].size() > 1) {
      auto& up = below[below[c].front()];
      up.insert(up.end(), below[c].begin() + 1, below[c].end());
    }
  }
  return below;
}

// [column] -> place, so that every column follows its descendants at once.
std::vector<uint32_t> postorder(const std::vector<std::vector<uint32_t>>& below) {
  const size_t n = below.size();
  std::vector<std::vector<uint32_t>> children(n);
  std::vector<uint32_t> roots, order(n), stack;
  for (uint32_t c = 0; c < n; ++c) (below[c].empty() ? roots : children[below[c].front()]).push_back(c);
  // Parents first and backwards, which is postorder turned round.
  uint32_t at = uint32_t(n);
  stack = roots;
  while (!stack.empty()) {
    const uint32_t c = stack.back();
    stack.pop_back();
    order[c] = --at;
    stack.insert(stack.end(), children[c].begin(), children[c].end());
  }
  return order;
}

// Whether a front of `count` columns and `reach` rows below goes together with the next one up: for few zeros that are
// then kept as if they were something.
bool joins(uint32_t count, size_t reach, uint32_t up_count, size_t up_reach) {
  constexpr uint32_t kNarrow = 4;
  constexpr double kZeros = 0.15;
  const double zeros = double(count) * double(up_count + up_reach - reach),
               all = double(count + up_count) * (0.5 * (count + up_count) + double(up_reach));
  return zeros == 0 || (count + up_count <= kNarrow && zeros < 0.5 * all) || zeros < kZeros * all;
}

}  // namespace

void FrontFactors::analyse(const BlockMatrix& matrix) {
  const size_t n = matrix.columns();
  place_ = minimum_degree(matrix);
  const std::vector<uint32_t> order = postorder(structure(matrix, place_));
  for (uint32_t& p : place_) p = order[p];
  const std::vector<std::vector<uint32_t>> below = structure(matrix, place_);
  // From the last column back: fronts grow by the columns before them.
  fronts_.clear();
  for (uint32_t c = uint32_t(n); c-- > 0;) {
    if (!fronts_.empty()) {
      Front& next = fronts_.back();
      const size_t reach = next.rows.size();
      if (!below[c].empty() && below[c].front() == c + 1 && next.first == c + 1 &&
          joins(1, below[c].size(), next.count, reach)) {
        --next.first, ++next.count;
        continue;
      }
    }
    fronts_.push_back({c, 1, below[c], {}, {}, {}});
  }
  std::reverse(fronts_.begin(), fronts_.end());
  std::vector<uint32_t> front_of(n);
  for (uint32_t f = 0; f < fronts_.size(); ++f)
    for (uint32_t k = 0; k < fronts_[f].count; ++k) front_of[fronts_[f].first + k] = f;
  for (uint32_t f = 0; f < fronts_.size(); ++f) {
    Front& front = fronts_[f];
    if (!front.rows.empty()) fronts_[front_of[front.rows.front()]].children.push_back(f);
    std::vector<uint32_t> own(front.count);
    for (uint32_t k = 0; k < front.count; ++k) own[k] = front.first + k;
    front.rows.insert(front.rows.begin(), own.begin(), own.end());
  }
  entries_.clear();
  for (uint32_t c = 0; c < n; ++c)
    for (uint32_t k = matrix.start[c]; k < matrix.start[c + 1]; ++k) {
      const uint32_t a = place_[c], b = place_[matrix.row[k]];
      entries_.push_back({k, std::max(a, b), std::min(a, b), b < a});
    }
  std::stable_sort(entries_.begin(), entries_.end(),
                   [](const Entry& a, const Entry& b) { return a.column < b.column; });
  entry_start_.assign(n + 1, 0);
  for (const Entry& e : entries_) ++entry_start_[e.column + 1];
  for (size_t c = 0; c < n; ++c) entry_start_[c + 1] += entry_start_[c];
}

bool FrontFactors::factorise(const BlockMatrix& matrix, double shift, const std::function<bool()>& over) {
  std::vector<uint32_t> local(place_.size(), kNone);  // row -> row of the front
  Matrix dense;
  for (Front& front : fronts_) {
    const long rows = long(3 * front.rows.size()), own = long(3 * front.count);
    if (over && rows >= kAsked && over()) return false;
    for (uint32_t k = 0; k < front.rows.size(); ++k) local[front.rows[k]] = k;
    dense.setZero(rows, rows);
    for (uint32_t k = entry_start_[front.first]; k < entry_start_[front.first + front.count]; ++k) {
      const Entry& e = entries_[k];
      const dmat3& b = matrix.block[e.block];
      const long r = 3 * long(local[e.row]), c = 3 * long(e.column - front.first);
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) dense(r + i, c + j) = e.turned ? b[i][j] : b[j][i];
    }
    for (long k = 0; k < own; ++k) dense(k, k) += shift;
    for (const uint32_t child : front.children) {
      const Front& from = fronts_[child];
      const size_t m = from.rows.size() - from.count;
      const ConstMap rest(from.rest.data(), long(3 * m), long(3 * m));
      for (size_t c = 0; c < m; ++c) {
        const long to_column = 3 * long(local[from.rows[from.count + c]]);
        for (size_t r = c; r < m; ++r)
          dense.block<3, 3>(3 * long(local[from.rows[from.count + r]]), to_column) +=
              rest.block<3, 3>(3 * long(r), 3 * long(c));
      }
    }
    // A large front goes by panels, so that `over` is asked every few seconds.
    const long width = own > kWhole ? kPanel : own;
    for (long from = 0; from < own; from += width) {
      if (from > 0 && over && over()) return false;
      const long panel = std::min(width, own - from), left = rows - from - panel;
      Eigen::Ref<Matrix> top = dense.block(from, from, panel, panel);
      const Eigen::LLT<Eigen::Ref<Matrix>> factored(top);
      if (factored.info() != Eigen::Success) return false;
      if (left == 0) continue;
      auto below = dense.block(from + panel, from, left, panel);
      top.triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(below);
      dense.bottomRightCorner(left, left).selfadjointView<Eigen::Lower>().rankUpdate(below, -1);
    }
    if (rows > own) {
      // Whole blocks on the diagonal: the upper corners of those are read above and thrown away.
      front.rest.resize(size_t((rows - own) * (rows - own)));
      Map(front.rest.data(), rows - own, rows - own) = dense.bottomRightCorner(rows - own, rows - own);
    }
    front.factor.resize(size_t(rows * own));
    Map(front.factor.data(), rows, own) = dense.leftCols(own);
  }
  return true;
}

void FrontFactors::solve(std::span<double> right) const {
  const long n = long(3 * place_.size());
  Map given(right.data(), n, long(right.size()) / n);
  Matrix x(n, given.cols()), part;
  for (size_t i = 0; i < place_.size(); ++i) x.middleRows(3 * long(place_[i]), 3) = given.middleRows(3 * long(i), 3);
  for (const Front& front : fronts_) {
    const long own = long(3 * front.count), rows = long(3 * front.rows.size());
    const ConstMap factor(front.factor.data(), rows, own);
    auto here = x.middleRows(3 * long(front.first), own);
    factor.topRows(own).triangularView<Eigen::Lower>().solveInPlace(here);
    part.noalias() = factor.bottomRows(rows - own) * here;
    for (size_t k = front.count; k < front.rows.size(); ++k)
      x.middleRows(3 * long(front.rows[k]), 3) -= part.middleRows(3 * long(k) - own, 3);
  }
  for (auto front = fronts_.rbegin(); front != fronts_.rend(); ++front) {
    const long own = long(3 * front->count), rows = long(3 * front->rows.size());
    const ConstMap factor(front->factor.data(), rows, own);
    part.resize(rows - own, x.cols());
    for (size_t k = front->count; k < front->rows.size(); ++k)
      part.middleRows(3 * long(k) - own, 3) = x.middleRows(3 * long(front->rows[k]), 3);
    auto here = x.middleRows(3 * long(front->first), own);
    here.noalias() -= factor.bottomRows(rows - own).transpose() * part;
    factor.topRows(own).triangularView<Eigen::Lower>().transpose().solveInPlace(here);
  }
  for (size_t i = 0; i < place_.size(); ++i) given.middleRows(3 * long(i), 3) = x.middleRows(3 * long(place_[i]), 3);
}

}  // namespace wale
