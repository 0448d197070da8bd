#pragma once
#include <array>
#include <optional>
#include <vector>

#include "geom/relax/front_factors.h"
#include "geom/relax/local_term.h"

namespace wale {

/// A step of all points and of the strains of the tile, as in LocalTerm.
struct TileStep {
  std::vector<dvec3> points;
  dvec2 strain{0, 0};
};

/// Second-order model of an energy: a sparse matrix of blocks for the points, bordered by the two strains, which every
/// point bears on. Sums run in the order of the calls, so results do not depend on threads.
class NewtonSystem {
 public:
  explicit NewtonSystem(size_t points);
  /// Begins anew, all zero. `terms` will be added: their pairs of points get a place in the matrix; where all have one
  /// from before, its pattern and symbolic factorisation are kept. Else `spare` points get places too: groups that may
  /// be in terms soon.
  void begin(const std::vector<LocalTerm>& terms, const std::vector<std::array<uint32_t, 4>>& spare);
  void add(const LocalTerm& term);
  void add_strain(const dvec2& gradient) { strain_gradient_ += gradient; }  ///< linear in the strains
  const std::vector<dvec3>& gradient() const { return gradient_; }
  dvec2 strain_gradient() const { return strain_gradient_; }
  /// -(H + damping)^-1 gradient, with the strains that are not free at 0; nothing where H + damping is not positive, or
  /// where `over` ended it.
  std::optional<TileStep> solve(double damping, bool free_x, bool free_y, const std::function<bool()>& over = {});
  /// Change of the second-order model without damping on a step.
  double model(const TileStep& step) const;

 private:
  void rebuild(const std::vector<LocalTerm>& terms, const std::vector<std::array<uint32_t, 4>>& spare);
  bool has(uint32_t row, uint32_t column) const;

  size_t count_;
  std::vector<dvec3> gradient_;
  dvec2 strain_gradient_{0, 0};
  std::vector<dvec3> border_[2];
  double strain_hessian_[3] = {};
  BlockMatrix hessian_;
  FrontFactors factors_;
};

}  // namespace wale
