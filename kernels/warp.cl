/* The warp of the flat knit on to the base mesh (KNIT21 Algorithm 1): W(x, y, z) = P(b) + z N(b), with P and N the
   barycentric point and the unit interpolated normal of the anchor's triangle. geom/warp.h is its reference in double. */
#pragma OPENCL FP_CONTRACT OFF
#include "geometry/vertex_frame.clh"
#include "shared/real.clh"
#include "shared/wale_types.h"

typedef struct Corners {
  float3 p0, p1, p2, n0, n1, n2;
} Corners;

static Corners corners_of(uint triangle, __global const float* positions, __global const float* normals,
                          __global const uint* triangles) {
  const uint i0 = triangles[3 * (size_t)triangle], i1 = triangles[3 * (size_t)triangle + 1];
  const uint i2 = triangles[3 * (size_t)triangle + 2];
  Corners c;
  c.p0 = vload3(i0, positions);
  c.p1 = vload3(i1, positions);
  c.p2 = vload3(i2, positions);
  c.n0 = vload3(i0, normals);
  c.n1 = vload3(i1, normals);
  c.n2 = vload3(i2, normals);
  return c;
}

/* Writes position and length of every vertex. */
__kernel void warp_points(__global const WAnchor* anchors, __global const float* positions,
                          __global const float* normals, __global const uint* triangles, __global float* vertices,
                          uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  const WAnchor a = anchors[i];
  const Corners c = corners_of(a.triangle, positions, normals, triangles);
  const float3 point = c.p0 + (a.b1 * (c.p1 - c.p0) + a.b2 * (c.p2 - c.p0));
  const float3 n = c.n0 + (a.b1 * (c.n1 - c.n0) + a.b2 * (c.n2 - c.n0));
  const float l = length(n);
  const float3 w = l > 1e-12f ? point + (a.height / l) * n : point;
  __global float* v = vertices + (size_t)i * W_VERTEX_WORDS;
  vstore3(w, 0, v);
  v[6] = a.length;
}

/* Carries the frame normal (fx, fy, fz) of the flat knit through the Jacobian, J f = fx W_x + fy W_y + fz N with
     W_x = P_x + z N_x,   N_x = (M_x - N (N.M_x))/|M|,   M the interpolated normal before it is made unit,
   where P_x = P_b (db/dx) and db/d(x,y) is the inverse of the corners' cloth coordinates, cloth: x, y of three corners a
   triangle, metres. Then makes it square to the mean of the two adjacent unit edges of the warped polyline.
   flags: bit 0 the vertex has no previous one, bit 1 no next one. Needs every vertex's position. */
__kernel void warp_normals(__global const WAnchor* anchors, __global const float* positions,
                           __global const float* normals, __global const uint* triangles, __global const float* cloth,
                           __global const uchar* flags, __global float* vertices, uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  const WAnchor a = anchors[i];
  const Corners c = corners_of(a.triangle, positions, normals, triangles);
  __global const float* uv = cloth + 6 * (size_t)a.triangle;
  const float x1 = uv[2] - uv[0], y1 = uv[3] - uv[1], x2 = uv[4] - uv[0], y2 = uv[5] - uv[1];
  const float det = x1 * y2 - x2 * y1, inv = det != 0.0f ? 1.0f / det : 0.0f;
  const float3 m = c.n0 + (a.b1 * (c.n1 - c.n0) + a.b2 * (c.n2 - c.n0));
  const float ml = fmax(length(m), 1e-12f);
  const float3 n = m / ml;
  /* Change of the barycentric weights 1 and 2 along (nx, ny). */
  const float d1 = (a.nx * y2 - a.ny * x2) * inv, d2 = (a.ny * x1 - a.nx * y1) * inv;
  const float3 point = d1 * (c.p1 - c.p0) + d2 * (c.p2 - c.p0);
  const float3 turn = (d1 * (c.n1 - c.n0) + d2 * (c.n2 - c.n0)) / ml;
  const float3 carried = point + a.height * (turn - dot(n, turn) * n) + a.nz * n;

  w_store_frame(vertices + (size_t)i * W_VERTEX_WORDS, carried, flags[i]);
}
