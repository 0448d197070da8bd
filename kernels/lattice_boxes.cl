/* Boxes of procedural leaves: what runs after every change of the lattice. */
#include "geometry/joint.clh"
#include "geometry/lattice.clh"

/* Point `to` so that the edge from `from` goes on straight. */
W_INLINE void go_on_straight(Points* p, uint to, uint at, uint from) {
  p->x[to] = p->x[at] + (p->x[at] - p->x[from]);
  p->y[to] = p->y[at] + (p->y[at] - p->y[from]);
  p->z[to] = p->z[at] + (p->z[at] - p->z[from]);
}

/* leaves: leaf numbers without W_LEAF_PROCEDURAL. boxes: lo x,y,z, hi x,y,z. Counts the mitres inside the yarns that
   would need a square cut and a sphere, which procedural leaves have at open ends only. A leaf knows one point beyond
   each of its ends: the edges there are taken to go straight on, and their other ends are looked at by the leaves that
   hold them. */
__kernel void lattice_boxes(__global const uint* leaves, __global const float* lattice, __global const uint* tiles,
                            uint patch_bits, uint joints, __global float* boxes, __global uint* tight, uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  __global const uint* patch = tiles + (leaves[i] & ((1u << patch_bits) - 1u)) * W_PATCH_WORDS;
  __global const float* corner = lattice + (size_t)(leaves[i] >> patch_bits) * W_LATTICE_WORDS;
  const uint layout = patch[W_LEAF_LAYOUT], n = layout & 255u, lanes = (layout >> 8) & 255u;
  const uint open = patch[W_PATCH_ENDS];
  Points point;
  clear_points(&point);
  for (uint at = 0; at < W_PATCH_POINTS; at += W_LANES)
    set_points(w_warped_lanes(tiles, patch, corner, at), &point, n + at);
  const uint last = lanes + 3 * n;
  for (uint p = 0; p < n; ++p) {
    go_on_straight(&point, p, p + n, p + 2 * n);
    go_on_straight(&point, p + last + n, p + last, p + last - n);
  }
  uint cuts;
  const Bounds box = bound_joints(&point, n, lanes, w_all(as_float(patch[W_LEAF_RADIUS])), open, joints,
                                  &cuts);
  const uint ply_bits = (1u << n) - 1u, ends = (open & 1u ? ply_bits : 0u) | (open & 2u ? ply_bits << lanes : 0u);
  if (joints == W_JOINTS_MITRE && (cuts & ~ends)) atomic_add(tight, popcount(cuts & ~ends));
  vstore3(box.lo, 2 * (size_t)i, boxes);
  vstore3(box.hi, 2 * (size_t)i + 1, boxes);
}
