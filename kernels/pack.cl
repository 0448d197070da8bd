/* Leaves and boxes of patches from warped vertices: what runs after the warp and after every change of the base mesh. */
#include "geometry/joint.clh"
#include "shared/wale_types.h"

/* One ply of a run: `vertices` of its W_VERTEX_WORDS words each, `count` of them. */
typedef struct Ply {
  __global const float* vertices;
  int count, ghosts;
} Ply;

W_INLINE float3 stored(const Ply* ply, int i) { return vload3(0, ply->vertices + (long)i * W_VERTEX_WORDS); }

/* Vertex i of the ply. Open ends repeat the end vertex; closed yarns go on round: their samples 0 and count - 3 are the
   same, displaced, so that both sides of the join see the same neighbours and decide alike. */
W_INLINE float3 vertex(const Ply* ply, int i) {
  const int last = ply->count - 1;
  if (i >= 0 && i <= last) return stored(ply, i);
  if (!ply->ghosts || last < 3) return stored(ply, i < 0 ? 0 : last);
  return i < 0 ? stored(ply, last - 3) + (stored(ply, 0) - stored(ply, last - 2))
               : stored(ply, 3) + (stored(ply, last) - stored(ply, 2));
}

/* What lies at vertex v: its two unit edges and whether it gets a square cut and a sphere. The decision looks at v - 2
   to v + 2 only, so that every leaf that meets the joint takes the same. */
typedef struct Joint {
  float3 before, after;
  int cut;
} Joint;

W_INLINE Joint joint_at(const Ply* ply, int v, float r) {
  const float3 a = vertex(ply, v - 2), b = vertex(ply, v - 1), c = vertex(ply, v), d = vertex(ply, v + 1);
  const float3 e = vertex(ply, v + 2);
  const float3 t0 = unit_edge(b - a, r), t1 = unit_edge(c - b, r), t2 = unit_edge(d - c, r), t3 = unit_edge(e - d, r);
  Joint joint;
  joint.before = t1;
  joint.after = t2;
  joint.cut = !ply->ghosts && (v == 0 || v == ply->count - 1);
  joint.cut |= dot(t1, t2) < W_MITRE_COS || bad_segment(c - b, t0, t1, t2, r) || bad_segment(d - c, t1, t2, t3, r);
  return joint;
}

/* patches: uint4 each: leaf offset (16-byte units), first vertex of the run's ply 0, vertices per ply, 1 if the run has
   ghost ends. The host has written the leaf's header but for CUTS and SPHERES, and zeros elsewhere.
   boxes: lo x,y,z, hi x,y,z. */
__kernel void pack_leaves(__global const uint4* patches, __global const float* vertices, __global uint* leaves,
                          __global float* boxes, uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  const uint4 patch = patches[i];
  __global uint* leaf = leaves + ((size_t)patch.x << 2);
  const uint layout = leaf[W_LEAF_LAYOUT], n = layout & 255u, lanes = (layout >> 8) & 255u, stride = layout >> 16;
  const int intervals = (int)(lanes / n), first = (int)(leaf[W_LEAF_SEGMENT] - patch.y);
  const float r = as_float(leaf[W_LEAF_RADIUS]);
  __global float* points = (__global float*)(leaf + W_LEAF_HEADER);
  uint cuts = 0, spheres = 0;
  float3 lo = (float3)(1e30f), hi = (float3)(-1e30f);
  for (uint p = 0; p < n; ++p) {
    Ply ply;
    ply.vertices = vertices + ((size_t)patch.y + (size_t)p * patch.z) * W_VERTEX_WORDS;
    ply.count = (int)patch.z;
    ply.ghosts = (int)patch.w;
    for (int k = 0; k <= intervals + 2; ++k) {
      const float3 x = vertex(&ply, first + k - 1);
      points[k * n + p] = x.x;
      points[stride + k * n + p] = x.y;
      points[2 * stride + k * n + p] = x.z;
    }
    const int last_traced = ply.ghosts ? ply.count - 2 : ply.count - 1; /* vertex where the run's tracing ends */
    for (int k = 0; k <= intervals; ++k) {
      const int v = first + k;
      const Joint joint = joint_at(&ply, v, r);
      const float3 c = vertex(&ply, v);
      /* The segment that starts at a joint owns its sphere; the last one of an open ply owns the end cap. */
      const int owned = joint.cut && (k < intervals || (!ply.ghosts && v == last_traced));
      if (joint.cut) {
        if (k < intervals) cuts |= 1u << (k * n + p);
        if (k > 0) cuts |= 1u << (16 + (k - 1) * n + p);
        if (owned) spheres |= k < intervals ? 1u << (k * n + p) : 1u << (16 + (k - 1) * n + p);
      }
      float3 extent;
      if (owned)
        extent = (float3)(r);
      else if (joint.cut)
        extent = disc_extent(joint.before, r);
      else
        extent = mitre_extent(joint.before, joint.after, r);
      extent += 4e-5f * r; /* the seam's overlap (W_MITRE_EPS) and rounding */
      lo = fmin(lo, c - extent);
      hi = fmax(hi, c + extent);
    }
  }
  leaf[W_LEAF_CUTS] = cuts;
  leaf[W_LEAF_SPHERES] = spheres;
  vstore3(lo, 2 * i, boxes);
  vstore3(hi, 2 * i + 1, boxes);
}
