#pragma once
/* What test kernels that trace lists of rays share: layouts of rays, hits and surfaces in buffers, and how they are
   read and written. In double builds hits and surfaces are double; rays are float always, as the program's are. */

namespace wale::test {

inline constexpr const char* kTraceTypes = R"(
#include "geometry/ply_surface.clh"
#ifndef W_TEST_NORMALS
#define W_TEST_NORMALS W_NORMALS_ROTATION_MINIMISING
#endif
typedef struct TestRay { float o[3], l[3], d[3]; float tmax; uint key, skip, skip_triangle, pad; } TestRay;
typedef struct TestHit { w_real t; uint kind, code; w_real u, v; uint occluded; } TestHit;
typedef struct TestSurface {
  w_real anchor[3], x[3], n[3], t[3], smooth_n[3], smooth_t[3]; w_real phi, u, length, radius, h; uint segment;
} TestSurface;

W_INLINE WRay ray_of(__global const TestRay* in) {
  WRay r;
  r.o = w_load3(0, in->o);
  r.l = w_load3(0, in->l);
  r.d = w_load3(0, in->d);
  r.tmax = in->tmax;
  r.key = in->key;
  r.skip = in->skip;
  r.skip_triangle = in->skip_triangle;
  return r;
}
W_INLINE void write_hit(const WScene* s, const WRay* r, __global TestHit* out) {
  const WHit hit = w_closest(s, r);
  out->t = hit.t;
  out->kind = hit.kind;
  out->code = hit.code;
  out->u = hit.u;
  out->v = hit.v;
  out->occluded = w_occluded(s, r);
}
W_INLINE void write_surface(const WScene* s, __global const float* frames, const WRay* r, __global const TestHit* in,
                            __global TestSurface* out) {
  WHit hit;
  hit.t = in->t;
  hit.kind = in->kind;
  hit.code = in->code;
  hit.u = in->u;
  hit.v = in->v;
  const WPlySurface p = w_ply_surface(s, frames, r, &hit, W_TEST_NORMALS);
  vstore3(p.anchor, 0, out->anchor);
  vstore3(p.x, 0, out->x);
  vstore3(p.n, 0, out->n);
  vstore3(p.t, 0, out->t);
  vstore3(p.smooth_n, 0, out->smooth_n);
  vstore3(p.smooth_t, 0, out->smooth_t);
  out->phi = p.phi;
  out->u = p.u;
  out->length = p.length;
  out->radius = p.radius;
  out->h = p.h;
  out->segment = p.segment;
}
)";

}  // namespace wale::test
