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
static inline w_v3 unit(__global const float* p) {
  return w_v3_all(normalize((w_real3)(p[0], p[1], p[2])));
}
/* One hit a work-item, in every lane. */
static inline WPlyMaterialLanes material_of(__global const WPlyMaterial* m) {
  WPlyMaterialLanes all;
  for (uint i = 0; i < W_LANES; ++i) w_ply_material_set_lane(&all, i, *m);
  return all;
}
static inline w_real pdf_of(const WPlyShade* s, int lobe, w_v3 w) {
  const w_vf p = w_ply_pdf(s, lobe, w);
  return w_lane_of(p, 0);
}
static inline WPlyShade shade_of(__global const WPlyMaterial* m, __global const float* p) {
  const WPlyMaterialLanes material = material_of(m);
#ifdef W_TEST_DETAIL /* a fibre that is turned, steep and in the shade of its neighbours */
  WFibreLanes fibre;
  fibre.tilt = w_all(R(-0.4));
  fibre.sin_turn = w_all(R(0.8));
  fibre.shadow = w_all(R(0.3));
  fibre.openness = w_all(R(0.2));
  fibre.widen = w_all(R(0.01));
  return w_ply_setup_detail(&material, unit(p), unit(p + 3), unit(p + 6), fibre);
#else
  return w_ply_setup(&material, unit(p), unit(p + 3), unit(p + 6));
#endif
}
/* 9 energies, 3 probabilities, h, c, gamma */
__kernel void energies(__global const WPlyMaterial* m, __global const float* in, __global w_real* out, uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  const WPlyShade s = shade_of(m, in + 9 * i);
  for (int k = 0; k < 3; ++k) {
    vstore3(w_v3_lane(&s.a[k], 0), k, out + 15 * i);
    out[15 * i + 9 + k] = w_lane_of(s.q[k], 0);
  }
  out[15 * i + 12] = w_lane_of(s.h, 0); out[15 * i + 13] = w_lane_of(s.c, 0); out[15 * i + 14] = w_lane_of(s.gamma, 0);
}
/* Densities of the three lobes for one direction each (3 more floats). */
__kernel void densities(__global const WPlyMaterial* m, __global const float* in, __global w_real* out, uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  const WPlyShade s = shade_of(m, in + 12 * i);
  for (int k = 0; k < 3; ++k) out[3 * i + k] = pdf_of(&s, k, unit(in + 12 * i + 9));
}
/* All lobes together: bsdf * cosine rgb, density. */
__kernel void evaluate(__global const WPlyMaterial* m, __global const float* in, __global w_real* out, uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  const WPlyShade s = shade_of(m, in + 12 * i);
  w_vf pdf;
  const w_v3 f = w_ply_eval(&s, unit(in + 12 * i + 9), &pdf);
  vstore3(w_v3_lane(&f, 0), 0, out + 4 * i);
  out[4 * i + 3] = w_lane_of(pdf, 0);
}
/* Density of one lobe on an n x n grid of (w.z, azimuth about z) for one configuration. */
__kernel void density_grid(__global const WPlyMaterial* m, __global const float* in, int lobe, uint n,
                           __global w_real* out, uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  const WPlyShade s = shade_of(m, in);
  const w_real z = R(2.0) * ((i / n) + R(0.5)) / n - R(1.0), phi = R(2.0) * W_PI * ((i % n) + R(0.5)) / n;
  const w_real r = sqrt(R(1.0) - z * z);
  out[i] = pdf_of(&s, lobe, w_v3_all((w_real3)(r * cos(phi), r * sin(phi), z)));
}
/* The same, times the cosine of theta, on a grid uniform in theta: it stays fine at the poles. */
__kernel void density_angles(__global const WPlyMaterial* m, __global const float* in, int lobe, uint n,
                             __global w_real* out, uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  const WPlyShade s = shade_of(m, in);
  const w_real theta = W_PI * (((i / n) + R(0.5)) / n - R(0.5)), phi = R(2.0) * W_PI * ((i % n) + R(0.5)) / n;
  const w_real r = cos(theta);
  out[i] = r * pdf_of(&s, lobe, w_v3_all((w_real3)(r * cos(phi), r * sin(phi), sin(theta))));
}
/* Samples: 4 numbers each -> lobe, direction, density, weight rgb. `step` 0: one configuration for all, else 9. */
__kernel void samples(__global const WPlyMaterial* m, __global const float* in, uint step, __global const float* u,
                      int fixed_lobe, __global w_real* out, uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  const WPlyShade s = shade_of(m, in + step * i);
  w_vf left;
  const w_vi drawn = w_ply_choose(&s, w_all(u[4 * i]), &left);
  const int chosen = w_lane_of_int(drawn, 0), lobe = fixed_lobe < 0 ? chosen : fixed_lobe;
  const w_v3 w = w_ply_sample(&s, (w_vi)(lobe), w_all(u[4 * i + 1]), w_all(u[4 * i + 2]), w_all(u[4 * i + 3]));
  out[9 * i] = chosen;
  vstore3(w_v3_lane(&w, 0), 0, out + 9 * i + 1);
  out[9 * i + 4] = pdf_of(&s, lobe, w);
  vstore3(w_v3_lane(&s.a[chosen], 0) / w_lane_of(s.q[chosen], 0), 0, out + 9 * i + 5);
  out[9 * i + 8] = w_lane_of(left, 0);
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
