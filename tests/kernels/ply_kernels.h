#pragma once
#include <array>
#include <cmath>
#include <vector>

#include "geom/vec.h"
#include "tests/kernels/kernel_runner.h"

namespace wale::test {

/// Test kernels of the ply BSDF. A configuration is 9 floats: t, n, wv.
inline const char* kPlyKernels = R"(
#include "appearance/ply_bsdf.clh"
static inline w_real3 vec(__global const float* p) { return (w_real3)(p[0], p[1], p[2]); }
static inline WPlyShade shade_of(__global const WPlyMaterial* m, __global const float* p) {
#ifdef W_TEST_DETAIL /* a fibre that is turned, steep and in the shade of its neighbours */
  WFibreAt fibre = w_fibre_mean(R(-0.4));
  fibre.sin_turn = R(0.8);
  fibre.shadow = R(0.3);
  fibre.openness = R(0.2);
  fibre.widen = R(0.01);
  return w_ply_setup_detail(*m, normalize(vec(p)), normalize(vec(p + 3)), normalize(vec(p + 6)), fibre);
#else
  return w_ply_setup(*m, normalize(vec(p)), normalize(vec(p + 3)), normalize(vec(p + 6)));
#endif
}
/* 9 energies, 3 probabilities, h, c, gamma */
__kernel void energies(__global const WPlyMaterial* m, __global const float* in, __global w_real* out, uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  const WPlyShade s = shade_of(m, in + 9 * i);
  for (int k = 0; k < 3; ++k) {
    vstore3(s.a[k], k, out + 15 * i);
    out[15 * i + 9 + k] = s.q[k];
  }
  out[15 * i + 12] = s.h; out[15 * i + 13] = s.c; out[15 * i + 14] = s.gamma;
}
/* Densities of the three lobes for one direction each (3 more floats). */
__kernel void densities(__global const WPlyMaterial* m, __global const float* in, __global w_real* out, uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  const WPlyShade s = shade_of(m, in + 12 * i);
  for (int k = 0; k < 3; ++k) out[3 * i + k] = w_ply_pdf(&s, k, normalize(vec(in + 12 * i + 9)));
}
/* All lobes together: bsdf * cosine rgb, density. */
__kernel void evaluate(__global const WPlyMaterial* m, __global const float* in, __global w_real* out, uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  const WPlyShade s = shade_of(m, in + 12 * i);
  w_real pdf;
  vstore3(w_ply_eval(&s, normalize(vec(in + 12 * i + 9)), &pdf), 0, out + 4 * i);
  out[4 * i + 3] = pdf;
}
/* Density of one lobe on an n x n grid of (w.z, azimuth about z) for one configuration. */
__kernel void density_grid(__global const WPlyMaterial* m, __global const float* in, int lobe, uint n,
                           __global w_real* out, uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  const WPlyShade s = shade_of(m, in);
  const w_real z = R(2.0) * ((i / n) + R(0.5)) / n - R(1.0), phi = R(2.0) * W_PI * ((i % n) + R(0.5)) / n;
  const w_real r = sqrt(R(1.0) - z * z);
  out[i] = w_ply_pdf(&s, lobe, (w_real3)(r * cos(phi), r * sin(phi), z));
}
/* The same, times the cosine of theta, on a grid uniform in theta: it stays fine at the poles. */
__kernel void density_angles(__global const WPlyMaterial* m, __global const float* in, int lobe, uint n,
                             __global w_real* out, uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  const WPlyShade s = shade_of(m, in);
  const w_real theta = W_PI * (((i / n) + R(0.5)) / n - R(0.5)), phi = R(2.0) * W_PI * ((i % n) + R(0.5)) / n;
  const w_real r = cos(theta);
  out[i] = r * w_ply_pdf(&s, lobe, (w_real3)(r * cos(phi), r * sin(phi), sin(theta)));
}
/* Samples: 4 numbers each -> lobe, direction, density, weight rgb. `step` 0: one configuration for all, else 9. */
__kernel void samples(__global const WPlyMaterial* m, __global const float* in, uint step, __global const float* u,
                      int fixed_lobe, __global w_real* out, uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  const WPlyShade s = shade_of(m, in + step * i);
  w_real left;
  const int chosen = w_ply_choose(&s, u[4 * i], &left), lobe = fixed_lobe < 0 ? chosen : fixed_lobe;
  const w_real3 w = w_ply_sample(&s, lobe, u[4 * i + 1], u[4 * i + 2], u[4 * i + 3]);
  const w_real3 weight = s.a[chosen] / s.q[chosen];
  out[9 * i] = chosen;
  vstore3(w, 0, out + 9 * i + 1);
  out[9 * i + 4] = w_ply_pdf(&s, lobe, w);
  vstore3(weight, 0, out + 9 * i + 5);
  out[9 * i + 8] = left;
}
)";

/// Viewer at offset h and angle theta to the normal plane of a ply along z.
inline std::array<dvec3, 3> ply_view(double h, double theta) {
  const double gamma = std::asin(h);
  return {dvec3(0, 0, 1), dvec3(std::cos(gamma), std::sin(gamma), 0), dvec3(std::cos(theta), 0, std::sin(theta))};
}

inline void append(std::vector<float>* out, dvec3 v) {
  for (int k = 0; k < 3; ++k) out->push_back(float(v[k]));
}
inline std::vector<float> floats(const std::array<dvec3, 3>& view) {
  std::vector<float> out;
  for (const dvec3& v : view) append(&out, v);
  return out;
}
/// Three consecutive floats as the unit vector that the kernels make of them.
inline dvec3 unit(const float* p) { return glm::normalize(dvec3(p[0], p[1], p[2])); }

}  // namespace wale::test
