#pragma once
#include <cstdint>

#include "geom/vec.h"

namespace wale {

/// One term of the energy of a tile, with its derivatives by the few points it depends on and by the strains (ex, ey)
/// of the whole tile. Points move as x -> diag(1 + ex, 1 + ey, 1) x + u, periods with them, so that a difference v of
/// points of any tiles changes by sum w_i u_i + (ex v.x, ey v.y, 0): strains never look at which tile a point is in.
struct LocalTerm {
  int count = 0;  ///< points, at most 4
  uint32_t point[4] = {};
  double energy = 0;
  dvec3 gradient[4] = {};         ///< by u
  dvec2 strain_gradient{0, 0};    ///< by ex, ey
  dmat3 hessian[4][4] = {};       ///< by u of p and u of q; only q <= p is kept
  dvec3 border[4][2] = {};        ///< by u of p and ex, ey
  double strain_hessian[3] = {};  ///< xx, xy, yy

  /// Adds f(v) with v = sum of weight * point (and periods): f's gradient and Hessian.
  void add(const double* weight, const dvec3& v, const dvec3& slope, const dmat3& curvature) {
    for (int p = 0; p < count; ++p) {
      gradient[p] += weight[p] * slope;
      for (int q = 0; q <= p; ++q) hessian[p][q] += weight[p] * weight[q] * curvature;
      for (int k = 0; k < 2; ++k) border[p][k] += weight[p] * v[k] * curvature[k];
    }
    strain_gradient += dvec2(slope) * dvec2(v);
    strain_hessian[0] += v.x * v.x * curvature[0][0];
    strain_hessian[1] += v.x * v.y * curvature[0][1];
    strain_hessian[2] += v.y * v.y * curvature[1][1];
  }

  /// Adds the mixed second derivative of f(v, w) by v (rows) and w (columns).
  void add_mixed(const double* weight_v, const dvec3& v, const double* weight_w, const dvec3& w, const dmat3& mixed) {
    const dmat3 turned = glm::transpose(mixed);
    for (int p = 0; p < count; ++p) {
      for (int q = 0; q <= p; ++q)
        hessian[p][q] += weight_v[p] * weight_w[q] * mixed + weight_w[p] * weight_v[q] * turned;
      for (int k = 0; k < 2; ++k) border[p][k] += weight_v[p] * w[k] * mixed[k] + weight_w[p] * v[k] * turned[k];
    }
    strain_hessian[0] += 2 * v.x * w.x * mixed[0][0];
    strain_hessian[1] += v.x * w.y * mixed[1][0] + v.y * w.x * mixed[0][1];
    strain_hessian[2] += 2 * v.y * w.y * mixed[1][1];
  }
};

/// What a term is asked for.
enum class Order { energy, derivatives };

}  // namespace wale
