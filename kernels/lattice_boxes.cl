/* Boxes of procedural leaves: what runs after every change of the lattice. */
#include "geometry/joint.clh"
#include "geometry/lattice.clh"

/* The largest number of points of one ply in a leaf: 16 intervals of one ply, and three more. */
#define W_MOST_POINTS 19

/* leaves: leaf numbers without W_LEAF_PROCEDURAL. boxes: lo x,y,z, hi x,y,z. Counts the joints inside the yarns that
   would need a square cut and a sphere, which procedural leaves have at open ends only (pack.cl decides alike). */
__kernel void lattice_boxes(__global const uint* leaves, __global const float* lattice, __global const uint* tiles,
                            uint patch_bits, __global float* boxes, __global uint* tight, uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  __global const uint* patch = tiles + (leaves[i] & ((1u << patch_bits) - 1u)) * W_PATCH_WORDS;
  __global const float* corner = lattice + (size_t)(leaves[i] >> patch_bits) * W_LATTICE_WORDS;
  const uint layout = patch[W_LEAF_LAYOUT], n = layout & 255u, lanes = (layout >> 8) & 255u;
  const int intervals = (int)(lanes / n);
  const float r = as_float(patch[W_LEAF_RADIUS]);
  const uint spheres = patch[W_LEAF_SPHERES];
  float3 lo = (float3)(1e30f), hi = (float3)(-1e30f);
  uint found = 0;
  for (uint p = 0; p < n; ++p) {
    float3 x[W_MOST_POINTS];
    for (int k = 0; k <= intervals + 2; ++k) x[k] = w_warped_point(tiles, patch, corner, k * n + p);
    for (int k = 1; k <= intervals + 1; ++k) {
      const float3 before = unit_edge(x[k] - x[k - 1], r), after = unit_edge(x[k + 1] - x[k], r);
      const uint start = 1u << ((k - 1) * n + p), end = 1u << (16 + (k - 2) * n + p);
      const int open = (k <= intervals && (spheres & start)) || (k > 1 && (spheres & end));
      if (!open) found += dot(before, after) < W_MITRE_COS;
      if (k <= intervals) {
        const float3 next = unit_edge(x[k + 2] - x[k + 1], r);
        found += bad_segment(x[k + 1] - x[k], before, after, next, r);
      }
      /* The seam's overlap (W_MITRE_EPS) and rounding. */
      const float3 extent = (open ? (float3)(r) : mitre_extent(before, after, r)) + 4e-5f * r;
      lo = fmin(lo, x[k] - extent);
      hi = fmax(hi, x[k] + extent);
    }
  }
  if (found) atomic_add(tight, found);
  vstore3(lo, 2 * i, boxes);
  vstore3(hi, 2 * i + 1, boxes);
}
