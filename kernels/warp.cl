/* The warp of the flat knit on to the base mesh (KNIT21 Algorithm 1): W(x, y, z) = P(b) + z N(b), with P and N the
   barycentric point and the unit interpolated normal of the anchor's triangle. geom/warp.h is its reference in double.
   A work-item warps W_LANES consecutive vertices. */
#include "geometry/vertex_frame.clh"
#include "shared/wale_types.h"

/* Anchors of W_LANES vertices with the corners of their triangles, one lane a vertex. */
typedef struct Lanes {
  w_real b1[W_LANES], b2[W_LANES], height[W_LANES];
  w_real x[6][W_LANES], y[6][W_LANES], z[6][W_LANES]; /* positions of three corners, then their normals */
} Lanes;

W_INLINE void set_corner(Lanes* lanes, uint corner, uint lane, float3 v) {
  lanes->x[corner][lane] = v.x;
  lanes->y[corner][lane] = v.y;
  lanes->z[corner][lane] = v.z;
}

/* Lanes beyond the last vertex repeat it. */
W_INLINE void gather(__global const WAnchor* anchors, __global const float* positions, __global const float* normals,
                     __global const uint* triangles, uint first, uint count, Lanes* lanes) {
  uint triangle = W_NONE;
  float3 p0, p1, p2, n0, n1, n2;
  p0 = p1 = p2 = n0 = n1 = n2 = (float3)(0.0f);
  for (uint lane = 0; lane < W_LANES; ++lane) {
    __global const WAnchor* a = anchors + min(first + lane, count - 1u);
    if (a->triangle != triangle) { /* neighbours often share theirs */
      triangle = a->triangle;
      __global const uint* corner = triangles + 3 * (size_t)triangle;
      p0 = vload3(corner[0], positions);
      p1 = vload3(corner[1], positions);
      p2 = vload3(corner[2], positions);
      n0 = vload3(corner[0], normals);
      n1 = vload3(corner[1], normals);
      n2 = vload3(corner[2], normals);
    }
    lanes->b1[lane] = a->b1;
    lanes->b2[lane] = a->b2;
    lanes->height[lane] = a->height;
    set_corner(lanes, 0, lane, p0);
    set_corner(lanes, 1, lane, p1);
    set_corner(lanes, 2, lane, p2);
    set_corner(lanes, 3, lane, n0);
    set_corner(lanes, 4, lane, n1);
    set_corner(lanes, 5, lane, n2);
  }
}

W_INLINE w_v3 corner(const Lanes* lanes, uint i) {
  w_v3 v;
  v.x = w_load(lanes->x[i]);
  v.y = w_load(lanes->y[i]);
  v.z = w_load(lanes->z[i]);
  return v;
}

/* s a + t b. */
W_INLINE w_v3 weighted(w_vf s, w_v3 a, w_vf t, w_v3 b) { return w_v3_fma(s, a, w_v3_scaled(t, b)); }

/* Writes where every vertex lies: x, y, z. */
__kernel void warp_points(__global const WAnchor* anchors, __global const float* positions,
                          __global const float* normals, __global const uint* triangles, __global float* points,
                          uint count) {
  const uint first = get_global_id(0) * W_LANES;
  if (first >= count) return;
  Lanes lanes;
  gather(anchors, positions, normals, triangles, first, count, &lanes);
  const w_vf b1 = w_load(lanes.b1), b2 = w_load(lanes.b2), height = w_load(lanes.height);
  const w_v3 p0 = corner(&lanes, 0), n0 = corner(&lanes, 3);
  const w_v3 point =
      w_v3_add(p0, weighted(b1, w_v3_sub(corner(&lanes, 1), p0), b2, w_v3_sub(corner(&lanes, 2), p0)));
  const w_v3 n = w_v3_add(n0, weighted(b1, w_v3_sub(corner(&lanes, 4), n0), b2, w_v3_sub(corner(&lanes, 5), n0)));
  const w_vf l = w_v3_norm(n);
  const w_vi is_long = w_lt(w_all(R(1e-12)), l);
  const w_v3 w = w_v3_fma(w_select(w_all(0), height / w_select(w_all(1), l, is_long), is_long), n, point);
  w_store(w.x, lanes.x[0]);
  w_store(w.y, lanes.y[0]);
  w_store(w.z, lanes.z[0]);
  for (uint lane = 0; lane < min((uint)W_LANES, count - first); ++lane)
    vstore3((float3)(lanes.x[0][lane], lanes.y[0][lane], lanes.z[0][lane]), first + lane, points);
}

/* Carries the frame normal (fx, fy, fz) of the flat knit through the Jacobian, J f = fx W_x + fy W_y + fz N with
     W_x = P_x + z N_x,   N_x = (M_x - N (N.M_x))/|M|,   M the interpolated normal before it is made unit,
   where P_x = P_b (db/dx) and db/d(x,y) is the inverse of the corners' cloth coordinates, cloth: x, y of three corners a
   triangle, metres. Then makes it square to the mean of the two adjacent unit edges of the warped polyline.
   flags: bit 0 the vertex has no previous one, bit 1 no next one. Needs the points of all vertices. */
__kernel void warp_normals(__global const WAnchor* anchors, __global const float* positions,
                           __global const float* normals, __global const uint* triangles, __global const float* cloth,
                           __global const uchar* flags, __global const float* points, __global float4* frames,
                           uint count) {
  const uint first = get_global_id(0) * W_LANES;
  if (first >= count) return;
  Lanes lanes;
  gather(anchors, positions, normals, triangles, first, count, &lanes);
  /* Change of the barycentric weights 1 and 2 along (fx, fy), and the polyline from one vertex before to one after. */
  w_real d1[W_LANES], d2[W_LANES], fz[W_LANES], x[W_LANES + 2], y[W_LANES + 2], z[W_LANES + 2];
  uint starts = 0, ends = 0;
  for (uint lane = 0; lane < W_LANES; ++lane) {
    const uint i = min(first + lane, count - 1u);
    __global const WAnchor* a = anchors + i;
    __global const float* uv = cloth + 6 * (size_t)a->triangle;
    const float x1 = uv[2] - uv[0], y1 = uv[3] - uv[1], x2 = uv[4] - uv[0], y2 = uv[5] - uv[1];
    const float det = x1 * y2 - x2 * y1, inv = det != 0.0f ? 1.0f / det : 0.0f;
    d1[lane] = (a->nx * y2 - a->ny * x2) * inv;
    d2[lane] = (a->ny * x1 - a->nx * y1) * inv;
    fz[lane] = a->nz;
    starts |= (flags[i] & 1u) << lane;
    ends |= (flags[i] >> 1 & 1u) << lane;
  }
  for (uint k = 0; k < W_LANES + 2; ++k) {
    const uint i = first + k > 0 ? min(first + k - 1u, count - 1u) : 0u;
    x[k] = points[3 * (size_t)i];
    y[k] = points[3 * (size_t)i + 1];
    z[k] = points[3 * (size_t)i + 2];
  }
  const w_vf b1 = w_load(lanes.b1), b2 = w_load(lanes.b2), s = w_load(d1), t = w_load(d2);
  const w_v3 p0 = corner(&lanes, 0), n0 = corner(&lanes, 3);
  const w_v3 n1 = w_v3_sub(corner(&lanes, 4), n0), n2 = w_v3_sub(corner(&lanes, 5), n0);
  const w_v3 m = w_v3_add(n0, weighted(b1, n1, b2, n2));
  const w_vf inv = w_all(1) / w_max(w_v3_norm(m), w_all(R(1e-12)));
  const w_v3 n = w_v3_scaled(inv, m);
  const w_v3 along = weighted(s, w_v3_sub(corner(&lanes, 1), p0), t, w_v3_sub(corner(&lanes, 2), p0));
  const w_v3 turn = w_v3_scaled(inv, weighted(s, n1, t, n2));
  const w_v3 square = w_v3_fma(-w_v3_dot(n, turn), n, turn);
  const w_v3 carried = w_v3_add(w_v3_fma(w_load(lanes.height), square, along), w_v3_scaled(w_load(fz), n));

  w_v3 before, here, after;
  before.x = w_load(x);
  before.y = w_load(y);
  before.z = w_load(z);
  here.x = w_load(x + 1);
  here.y = w_load(y + 1);
  here.z = w_load(z + 1);
  after.x = w_load(x + 2);
  after.y = w_load(y + 2);
  after.z = w_load(z + 2);
  before = w_v3_select(before, here, w_bits_mask(starts));
  after = w_v3_select(after, here, w_bits_mask(ends));
  const w_v3 frame = w_vertex_frame(carried, before, here, after);
  w_store(frame.x, x);
  w_store(frame.y, y);
  w_store(frame.z, z);
  for (uint lane = 0; lane < min((uint)W_LANES, count - first); ++lane)
    frames[first + lane] = (float4)(x[lane], y[lane], z[lane], anchors[first + lane].length);
}
