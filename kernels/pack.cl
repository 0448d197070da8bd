/* Leaves and boxes of patches from warped points: what runs after the warp and after every change of the base mesh. A
   work-item packs one patch, W_LANES of its points at a time; point (j, p) of ply p stands at index j*n + p of arrays,
   j = 0 being the vertex two before the patch's first. */
#include "geometry/real.clh"
#include "shared/wale_types.h"

/* Joints bent more than this (cosine of 120 degrees) get a sphere: the mitre's spike would pass 2 r. */
#define W_MITRE_COS R(-0.5)
/* Share of r below which a segment counts as a point. */
#define W_POINT_SEGMENT R(1e-5)
/* Points of a patch with two vertices before and after it: 16 + 5*8 at most; and what vectors read beyond them. */
#define W_POINTS 80

/* One ply of a run: its vertices, `count` of them. */
typedef struct Ply {
  __global const float* vertices; /* x, y, z */
  int count, ghosts;
} Ply;

W_INLINE float3 stored(const Ply* ply, int i) { return vload3((size_t)i, ply->vertices); }

/* Vertex i of the ply. Open ends repeat the end vertex; closed yarns go on round: their samples 0 and count - 3 are the
   same, displaced, so that both sides of the join see the same neighbours and decide alike. */
W_INLINE float3 vertex(const Ply* ply, int i) {
  const int last = ply->count - 1;
  if (i >= 0 && i <= last) return stored(ply, i);
  if (!ply->ghosts || last < 3) return stored(ply, i < 0 ? 0 : last);
  return i < 0 ? stored(ply, last - 3) + (stored(ply, 0) - stored(ply, last - 2))
               : stored(ply, 3) + (stored(ply, last) - stored(ply, 2));
}

typedef struct Points {
  w_real x[W_POINTS], y[W_POINTS], z[W_POINTS];
} Points;

W_INLINE w_v3 points_at(const Points* p, uint i) {
  w_v3 v;
  v.x = w_load(p->x + i);
  v.y = w_load(p->y + i);
  v.z = w_load(p->z + i);
  return v;
}
W_INLINE void set_points(w_v3 v, Points* p, uint i) {
  w_store(v.x, p->x + i);
  w_store(v.y, p->y + i);
  w_store(v.z, p->z + i);
}

/* Half extents along one axis, in radii: of the disc square to unit t (t = 0: the sphere) ... */
W_INLINE w_vf disc_extent(w_vf t) { return sqrt(w_max(w_all(1) - t * t, w_all(0))); }
/* ... and of the mitre ellipse of unit edges t0, t1 with s = t0 + t1, d = t1 - t0: the half axes are r across the bend
   and r/cos(b/2) in its plane, and along x they give r^2 (1 - m_x^2 + d_x^2/|s|^2), m = s/|s|. */
W_INLINE w_vf mitre_extent(w_vf s, w_vf d, w_vf ss) {
  return sqrt(w_max(w_all(1) + (d * d - s * s) / ss, w_all(0)));
}

typedef struct Bounds {
  float3 lo, hi;
} Bounds;

W_INLINE float least(w_vf v) {
  float a[W_LANES];
  w_store(v, a);
  float m = a[0];
  for (uint i = 1; i < W_LANES; ++i) m = a[i] < m ? a[i] : m;
  return m;
}

/* run: leaf offset (16-byte units), first vertex of the run's ply 0, vertices per ply, 1 if the run has ghost ends. The
   host has written the leaf's header but for CUTS and SPHERES. Returns the leaf's box. What happens at a joint follows
   from the vertices two before to two after it only, so that every leaf that meets the joint decides alike. */
W_INLINE Bounds pack_leaf(uint4 run, __global const float* positions, __global uint* leaves) {
  __global uint* leaf = leaves + ((size_t)run.x << 2);
  const uint layout = leaf[W_LEAF_LAYOUT], n = layout & 255u, lanes = (layout >> 8) & 255u, stride = layout >> 16;
  const int intervals = (int)(lanes / n), first = (int)(leaf[W_LEAF_SEGMENT] - run.y);
  const w_vf r = w_all(as_float(leaf[W_LEAF_RADIUS]));
  Points point, edge; /* edge i is the unit one from point i to i + n, or zero for a segment that is a point */
  w_real lengths[W_POINTS], reach[W_POINTS], cosine[W_POINTS];
  for (uint at = 0; at < W_POINTS; at += W_LANES) {
    w_store(w_all(0), point.x + at);
    w_store(w_all(0), point.y + at);
    w_store(w_all(0), point.z + at);
  }
  for (uint p = 0; p < n; ++p) {
    Ply ply;
    ply.vertices = positions + ((size_t)run.y + (size_t)p * run.z) * 3;
    ply.count = (int)run.z;
    ply.ghosts = (int)run.w;
    const int inside = first >= 2 && first + intervals + 2 < ply.count;
    for (int j = 0; j < intervals + 5; ++j) {
      const float3 x = inside ? stored(&ply, first - 2 + j) : vertex(&ply, first - 2 + j);
      const uint at = (uint)j * n + p;
      point.x[at] = x.x;
      point.y[at] = x.y;
      point.z[at] = x.z;
    }
  }
  __global float* out = (__global float*)(leaf + W_LEAF_HEADER);
  for (uint at = 0; at < stride; at += 4) {
    vstore4(vload4(0, point.x + n + at), 0, out + at);
    vstore4(vload4(0, point.y + n + at), 0, out + stride + at);
    vstore4(vload4(0, point.z + n + at), 0, out + 2 * stride + at);
  }

  /* Vectors read a little beyond what loops have written: zeros. */
  const w_v3 none = w_v3_all((w_real3)(0));
  uint i = 0;
  for (; i < lanes + 4 * n; i += W_LANES) {
    const w_v3 e = w_v3_sub(points_at(&point, i + n), points_at(&point, i));
    const w_vf l = sqrt(w_v3_dot(e, e)), inv = w_all(1) / l;
    const w_vi is_edge = w_lt(r * w_all(W_POINT_SEGMENT), l);
    set_points(w_v3_select(none, w_v3_fma(inv, e, none), is_edge), &edge, i);
    w_store(w_select(w_all(R(-1.0)), l, is_edge), lengths + i);
  }
  set_points(none, &edge, i);
  w_store(none.x, lengths + i);
  /* At point i + n: the cosine of the bend b and r tan(b/2). */
  for (i = 0; i < lanes + 3 * n; i += W_LANES) {
    const w_v3 t0 = points_at(&edge, i), t1 = points_at(&edge, i + n), k = w_v3_cross(t0, t1);
    const w_vf c = w_v3_dot(t0, t1);
    w_store(c, cosine + i);
    w_store(r * sqrt(w_v3_dot(k, k)) / w_max(w_all(1) + c, w_all(R(1e-6))), reach + i);
  }
  w_store(none.x, cosine + i);
  w_store(none.x, reach + i);
  const int open_start = !run.w && first == 0, open_end = !run.w && first + intervals == (int)run.z - 1;
  const uint segments = (1u << lanes) - 1u, joints = (1u << (lanes + n)) - 1u;
  const uint ends = (open_start ? (1u << n) - 1u : 0u) | (open_end ? joints & ~segments : 0u);
  /* The segment that starts at a joint owns its sphere; the last one of an open ply owns the end cap. */
  const uint owners = open_end ? joints : segments;
  uint cut_joints = 0;
  const w_vf far = w_all(R(1e30));
  w_v3 lo = w_v3_all((w_real3)(R(1e30))), hi = w_v3_all((w_real3)(R(-1e30)));
  for (i = 0; i < lanes + n; i += W_LANES) {
    const w_v3 t0 = points_at(&edge, i + n), t1 = points_at(&edge, i + 2 * n), c = points_at(&point, i + 2 * n);
    /* A mitre is valid iff L >= r (tan(b0/2) + tan(b1/2)) on both sides. */
    const w_vf at = w_load(reach + i + n);
    const w_vi bad = w_lt(w_load(lengths + i + n), w_load(reach + i) + at) |
                     w_lt(w_load(lengths + i + 2 * n), at + w_load(reach + i + 2 * n));
    const w_vi sharp = bad | w_lt(w_load(cosine + i + n), w_all(W_MITRE_COS));
    const uint bits = (w_mask_bits(sharp) | ends >> i) & (joints >> i);
    cut_joints |= bits << i;
    const w_vi cut = w_bits_mask(bits), owned = w_bits_mask(bits & owners >> i), outside = w_bits_mask(~(joints >> i));
    w_v3 s, d, extent;
    s.x = t0.x + t1.x;
    s.y = t0.y + t1.y;
    s.z = t0.z + t1.z;
    d = w_v3_sub(t1, t0);
    const w_vf ss = w_v3_dot(s, s);
    extent.x = w_select(w_select(mitre_extent(s.x, d.x, ss), disc_extent(t0.x), cut), w_all(1), owned);
    extent.y = w_select(w_select(mitre_extent(s.y, d.y, ss), disc_extent(t0.y), cut), w_all(1), owned);
    extent.z = w_select(w_select(mitre_extent(s.z, d.z, ss), disc_extent(t0.z), cut), w_all(1), owned);
    const w_vf more = w_all(R(4e-5)); /* the seam's overlap (W_MITRE_EPS) and rounding */
    extent.x = r * (extent.x + more);
    extent.y = r * (extent.y + more);
    extent.z = r * (extent.z + more);
    lo.x = w_min(w_select(c.x - extent.x, far, outside), lo.x);
    lo.y = w_min(w_select(c.y - extent.y, far, outside), lo.y);
    lo.z = w_min(w_select(c.z - extent.z, far, outside), lo.z);
    hi.x = w_max(w_select(c.x + extent.x, -far, outside), hi.x);
    hi.y = w_max(w_select(c.y + extent.y, -far, outside), hi.y);
    hi.z = w_max(w_select(c.z + extent.z, -far, outside), hi.z);
  }
  leaf[W_LEAF_CUTS] = (cut_joints & segments) | (cut_joints >> n & segments) << 16;
  leaf[W_LEAF_SPHERES] =
      (cut_joints & segments) | (open_end ? cut_joints >> lanes << (16 + lanes - n) : 0u);
  Bounds box;
  box.lo = (float3)(least(lo.x), least(lo.y), least(lo.z));
  box.hi = -(float3)(least(-hi.x), least(-hi.y), least(-hi.z));
  return box;
}

/* boxes: lo x,y,z, hi x,y,z. */
__kernel void pack_leaves(__global const uint4* runs, __global const float* positions, __global uint* leaves,
                          __global float* boxes, uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  const Bounds box = pack_leaf(runs[i], positions, leaves);
  vstore3(box.lo, 2 * (size_t)i, boxes);
  vstore3(box.hi, 2 * (size_t)i + 1, boxes);
}

/* Packs again and writes each leaf's box where the tree holds it: places are 16 * node + slot. Widened as by
   build_wide_tree. */
__kernel void refit_leaves(__global const uint4* runs, __global const float* positions, __global uint* leaves,
                           __global const uint* places, __global float* nodes, uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  const Bounds box = pack_leaf(runs[i], positions, leaves);
  const float3 lo = box.lo - (fabs(box.lo) * 4.8e-7f + 1e-30f), hi = box.hi + (fabs(box.hi) * 4.8e-7f + 1e-30f);
  __global float* f = nodes + (size_t)(places[i] / W_NODE_WIDTH) * W_NODE_WORDS + places[i] % W_NODE_WIDTH;
  f[0] = lo.x;
  f[16] = lo.y;
  f[32] = lo.z;
  f[48] = hi.x;
  f[64] = hi.y;
  f[80] = hi.z;
}

/* Nodes [first, first + count) of one level write their bounds where their parents hold them; below them all is done.
   Empty children do not count: their boxes are inside out. */
__kernel void refit_nodes(__global const uint* parents, __global float* nodes, uint first, uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  __global const float* f = nodes + (size_t)(first + i) * W_NODE_WORDS;
  const uint place = parents[first + i];
  __global float* out = nodes + (size_t)(place / W_NODE_WIDTH) * W_NODE_WORDS + place % W_NODE_WIDTH;
  for (uint side = 0; side < 6; ++side, f += W_NODE_WIDTH, out += W_NODE_WIDTH) {
    float m = f[0];
    for (uint slot = 1; slot < W_NODE_WIDTH; ++slot) m = side < 3 ? fmin(m, f[slot]) : fmax(m, f[slot]);
    *out = m;
  }
}
