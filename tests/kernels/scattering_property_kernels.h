#pragma once

namespace wale::test {

/// Test kernels of scattering in coordinates that resolve the narrowest lobe: angle to the lobe's own axis, and azimuth
/// about it, both measured from the lobe's middle. Views as in ply_kernels.h, one for all items.
inline const char* kScatteringKernels = R"(
#include "appearance/fibre_bsdf.clh"
#include "appearance/ply_bsdf.clh"
#include "appearance/surface.clh"
static inline w_real3 vec(__global const float* p) { return (w_real3)(p[0], p[1], p[2]); }

/* A lobe's frame: its axis, the azimuth's zero, and the two angles of its middle. */
typedef struct Lobe { w_real3 t, x, y; w_real theta, phi; } Lobe;
static inline void angles(const Lobe* f, w_real3 w, __global w_real* out) {
  const w_real along = dot(w, f->t), wx = dot(w, f->x), wy = dot(w, f->y);
  out[0] = atan2(along, sqrt(wx * wx + wy * wy)) - f->theta;
  out[1] = w_wrap_angle(atan2(wy, wx) - f->phi);
}
/* The direction of two such angles; *jacobian = solid angle per both. */
static inline w_real3 direction(const Lobe* f, __global const float* in, w_real* jacobian) {
  const w_real theta = f->theta + in[0], phi = f->phi + in[1];
  *jacobian = fabs(theta) < R(0.5) * W_PI ? cos(theta) : R(0.0);
  return f->t * sin(theta) + (f->x * cos(phi) + f->y * sin(phi)) * cos(theta);
}

static inline WPlyShade ply_shade(__global const WPlyMaterial* m, __global const float* v) {
  WPlyMaterialLanes material;
  for (uint i = 0; i < W_LANES; ++i) w_ply_material_set_lane(&material, i, *m);
  return w_ply_setup(&material, w_v3_all(normalize(vec(v))), w_v3_all(normalize(vec(v + 3))),
                     w_v3_all(normalize(vec(v + 6))));
}
static inline Lobe ply_lobe(const WPlyShade* s, int lobe) {
  Lobe f;
  const int surface = lobe == W_LOBE_R;
  f.t = w_v3_lane(surface ? &s->tf : &s->t, 0);
  f.x = w_v3_lane(surface ? &s->xf : &s->x, 0);
  f.y = w_v3_lane(surface ? &s->yf : &s->y, 0);
  f.theta = surface ? -atan2(s->sin_vf, s->cos_vf) : -atan2(s->sin_v, s->cos_v);
  f.phi = surface ? atan2(s->sin_n, s->cos_n) : lobe == W_LOBE_F ? s->center_f : s->center_b;
  return f;
}
__kernel void ply_samples(__global const WPlyMaterial* m, __global const float* view, __global const float* u, int lobe,
                          __global w_real* out, uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  const WPlyShade s = ply_shade(m, view);
  const Lobe f = ply_lobe(&s, lobe);
  const w_v3 w = w_ply_sample(&s, (w_vi)(lobe), w_all(u[4 * i]), w_all(u[4 * i + 1]), w_all(u[4 * i + 2]));
  angles(&f, w_v3_lane(&w, 0), out + 2 * i);
}
__kernel void ply_density(__global const WPlyMaterial* m, __global const float* view, __global const float* in, int lobe,
                          __global w_real* out, uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  const WPlyShade s = ply_shade(m, view);
  const Lobe f = ply_lobe(&s, lobe);
  w_real jacobian;
  const w_real3 w = direction(&f, in + 2 * i, &jacobian);
  out[i] = jacobian * w_ply_pdf(&s, lobe, w_v3_all(w));
}

static inline WFibreShade fibre_shade(__global const WFibreMaterial* m, __global const float* v) {
  return w_fibre_setup(*m, normalize(vec(v)), normalize(vec(v + 3)), normalize(vec(v + 6)));
}
static inline Lobe fibre_lobe(const WFibreShade* s, int lobe) {
  Lobe f;
  f.t = s->t;
  f.x = s->x;
  f.y = s->y;
  f.theta = -atan2(s->sin_v, s->cos_v);
  f.phi = lobe == W_FIBRE_R ? R(0.0) : W_PI;
  return f;
}
__kernel void fibre_samples(__global const WFibreMaterial* m, __global const float* view, __global const float* u,
                            int lobe, __global w_real* out, uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  const WFibreShade s = fibre_shade(m, view);
  const Lobe f = fibre_lobe(&s, lobe);
  angles(&f, w_fibre_sample(&s, lobe, u[4 * i], u[4 * i + 1], u[4 * i + 2], u[4 * i + 3]), out + 2 * i);
}
__kernel void fibre_density(__global const WFibreMaterial* m, __global const float* view, __global const float* in,
                            int lobe, __global w_real* out, uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  const WFibreShade s = fibre_shade(m, view);
  const Lobe f = fibre_lobe(&s, lobe);
  w_real jacobian;
  const w_real3 w = direction(&f, in + 2 * i, &jacobian);
  out[i] = jacobian * w_fibre_pdf(&s, lobe, w);
}

/* rgb weight and density of one sample; view in the frame of the normal z. */
__kernel void surface_weights(__global const WSurfaceMaterial* m, __global const float* view, __global const float* u,
                              __global w_real* out, uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  w_real3 wl;
  w_real pdf;
  vstore3(w_surface_sample(*m, (w_real3)(R(0.0), R(0.0), R(1.0)), normalize(vec(view)), u[3 * i], u[3 * i + 1],
                           u[3 * i + 2], &wl, &pdf), 0, out + 4 * i);
  out[4 * i + 3] = pdf;
}
/* Bsdf without the cosine, rgb, from a to b and from b to a. */
__kernel void surface_both_ways(__global const WSurfaceMaterial* m, __global const float* in, __global w_real* out,
                                uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  const w_real3 n = (w_real3)(R(0.0), R(0.0), R(1.0)), a = normalize(vec(in + 6 * i)), b = normalize(vec(in + 6 * i + 3));
  w_real pdf;
  vstore3(w_surface_eval(*m, n, a, b, &pdf) / b.z, 0, out + 6 * i);
  vstore3(w_surface_eval(*m, n, b, a, &pdf) / a.z, 0, out + 6 * i + 3);
}
)";

}  // namespace wale::test
