#pragma once
#include <cstdint>
#include <vector>

#include "geom/fibre_section.h"
#include "geom/stored_length.h"
#include "geom/vec.h"

namespace wale {

/// The fibres of a ply as curves about its axis. Where the ply has the frame (n, t x n) and the unwrapped stored length
/// l, fibre k lies at R rho_k (cos(a_k + kappa l), sin(a_k + kappa l)): kappa = twist / R and the rate of migration,
/// each rounded to whole turns in one period of stored lengths (kernels/appearance/fibre_phase.clh).
class FibreBundle {
 public:
  /// Throws the user errors of make_fibre_section.
  FibreBundle(const FibreRecipe& recipe, double ply_radius);

  size_t size() const { return section_.fibres.size(); }
  double fibre_radius() const { return section_.fibre_radius * ply_radius_; }  ///< metres

  /// Migration about one closed ply: whole swings in `lap` metres of stored length; `lap` 0: the open ply's.
  double migration_per_metre(double lap) const;

  /// Metres along n and t x n at unwrapped stored length l.
  dvec2 offset(size_t fibre, double l, double migration_per_metre) const;

  /// Fibres in runs of at most `group` neighbours of the section: first[g] .. first[g+1) of `order`.
  void groups(uint32_t group, std::vector<uint32_t>& order, std::vector<uint32_t>& first) const;

 private:
  FibreRecipe recipe_;
  double ply_radius_;
  FibreSection section_;
  double kappa_ = 0;  ///< radians per metre
};

/// Upper bound of the curvature, 1/m, that winding and migration give to any fibre of a straight ply.
double winding_curvature(const FibreRecipe& recipe, double ply_radius);

}  // namespace wale
