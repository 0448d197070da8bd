#pragma once
#include <array>

#include "geom/vec.h"
#include "shared/wale_types.h"

namespace wale::test {

/// The ply BSDF again, in double and by angles, written from its formulas and not from the kernels.
struct PlyOracle {
  PlyOracle(const WPlyMaterial& material, dvec3 t, dvec3 n, dvec3 wv);

  std::array<dvec3, 3> energy;  ///< R, F, B
  double h, c, gamma;

  double pdf(int lobe, dvec3 w) const;

 private:
  WPlyMaterial m_;
  dvec3 t_, tf_;
  dvec3 x_, y_, xf_, yf_;
  double theta_v_, theta_vf_, phi_n_;
};

/// d'Eon's M by angles, from the textbook form with a logarithm where it would overflow.
double oracle_longitudinal(double theta_i, double theta_o, double variance);
/// Density of the logistic on [-pi, pi] by cosh and tanh.
double oracle_trimmed_logistic(double x, double s);
/// The same with one scale below 0 and another above, equal densities at 0.
double oracle_skewed_logistic(double x, double below, double above);

}  // namespace wale::test
