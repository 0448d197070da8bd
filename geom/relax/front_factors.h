#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "geom/vec.h"

namespace wale {

/// Symmetric matrix of 3x3 blocks, its lower triangle by columns: rows ascending, the diagonal block first (and whole).
struct BlockMatrix {
  std::vector<uint32_t> start;  ///< of each column in `row` and `block`, and the end of the last one
  std::vector<uint32_t> row;
  std::vector<dmat3> block;
  size_t columns() const { return start.size() - 1; }
};

/// Cholesky factors of such a matrix by the multifrontal method (Duff and Reid 1983; Liu 1992): columns of like
/// structure are eliminated together in a dense matrix, whose rest is added to the front of the tree's next node up.
/// Columns are in the order of approximate minimum degree (Amestoy et al. 1996). Sums run in a fixed order.
class FrontFactors {
 public:
  /// Where entries are; values do not matter. Once for all matrices of the same structure.
  void analyse(const BlockMatrix& matrix);
  /// Factors of the matrix with `shift` added to its diagonal; false where that is not positive definite, or where
  /// `over` ended it: one matrix of a wide cable takes minutes.
  bool factorise(const BlockMatrix& matrix, double shift, const std::function<bool()>& over = {});
  /// Solves for right sides, one after another in `right`, in place, after factorise() was true.
  void solve(std::span<double> right) const;

 private:
  struct Front {
    uint32_t first = 0, count = 0;     // columns that are eliminated here, in elimination order
    std::vector<uint32_t> rows;        // those and all that they reach, in elimination order
    std::vector<uint32_t> children;    // fronts
    std::vector<double> factor, rest;  // by columns, lower: of those eliminated, all rows; and what goes up
  };
  struct Entry {
    uint32_t block = 0, row = 0, column = 0;  // row >= column, in elimination order
    bool turned = false;
  };

  std::vector<uint32_t> place_;  // of a column in elimination order
  std::vector<Front> fronts_;    // children before parents
  std::vector<Entry> entries_;   // by their columns
  std::vector<uint32_t> entry_start_;
};

}  // namespace wale
