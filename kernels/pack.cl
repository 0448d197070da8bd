/* Leaves and boxes of patches from warped points: what runs after the warp and after every change of the base mesh. A
   work-item packs one patch, W_LANES of its points at a time; point (j, p) of ply p stands at index j*n + p of arrays,
   j = 0 being the vertex two before the patch's first. */
#include "geometry/joint.clh"
#include "geometry/steps.clh"
#include "shared/wale_types.h"

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

/* run: number of the leaf in its buffer (16-byte units), first vertex of the run's ply 0, vertices per ply, 1 if the run
   has ghost ends. joints: W_JOINTS_*. The host has written the leaf's header but for CUTS, SPHERES and W_LAYOUT_CAPSULES. Returns the leaf's box. What happens
   at a joint follows from the vertices two before to two after it only, so that every leaf that meets the joint decides
   alike.
   steps: see shared/vertices.h; read where the header says W_LAYOUT_QUANTISED: then all that follows, joints and boxes
   too, is of the points as rays will read them. */
W_INLINE Bounds pack_leaf(uint4 run, __global const float* positions, uint joints, __global const uint* steps,
                          __global uint* leaves) {
  __global uint* leaf = leaves + ((size_t)run.x << 2);
  const uint layout = leaf[W_LEAF_LAYOUT], n = layout & 255u, lanes = (layout >> 8) & 255u;
  const uint stride = W_LAYOUT_STRIDE(layout);
  const int intervals = (int)(lanes / n), first = (int)(leaf[W_LEAF_SEGMENT] - run.y);
  const w_vf r = w_all(as_float(leaf[W_LEAF_RADIUS]));
  const int quantised = (layout & W_LAYOUT_QUANTISED) != 0u;
  const float step = quantised ? step_of(leaf, steps) : 0.0f;
  int broken = 0; /* has a point that no integer stands for: told to the host by a box that is no box */
  Points point;
  clear_points(&point);
  for (uint p = 0; p < n; ++p) {
    Ply ply;
    ply.vertices = positions + ((size_t)run.y + (size_t)p * run.z) * 3;
    ply.count = (int)run.z;
    ply.ghosts = (int)run.w;
    const int inside = first >= 2 && first + intervals + 2 < ply.count;
    for (int j = 0; j < intervals + 5; ++j) {
      float3 x = inside ? stored(&ply, first - 2 + j) : vertex(&ply, first - 2 + j);
      if (quantised) {
        broken |= no_number(x);
        x = on_steps(x, step);
      }
      const uint at = (uint)j * n + p;
      point.x[at] = x.x;
      point.y[at] = x.y;
      point.z[at] = x.z;
    }
  }
  if (quantised) {
    const uint count = lanes + 3 * n;
    __global ushort* out = (__global ushort*)(leaf + W_QUANTISED_LEAF_HEADER);
    leaf[W_LEAF_STEP] = as_uint(step);
    leaf[W_LEAF_ORIGIN] = write_steps(point.x + n, count, stride, step, out);
    leaf[W_LEAF_ORIGIN + 1] = write_steps(point.y + n, count, stride, step, out + stride);
    leaf[W_LEAF_ORIGIN + 2] = write_steps(point.z + n, count, stride, step, out + 2 * stride);
  } else {
    __global float* out = (__global float*)(leaf + W_LEAF_HEADER);
    for (uint at = 0; at < stride; at += 4) {
      vstore4(vload4(0, point.x + n + at), 0, out + at);
      vstore4(vload4(0, point.y + n + at), 0, out + stride + at);
      vstore4(vload4(0, point.z + n + at), 0, out + 2 * stride + at);
    }
  }

  uint cut_joints;
  const int open_start = !run.w && first == 0, open_end = !run.w && first + intervals == (int)run.z - 1;
  Bounds box =
      bound_joints(&point, n, lanes, r, (open_start ? 1u : 0u) | (open_end ? 2u : 0u), joints, &cut_joints);
  if (broken) box.lo = (float3)(NAN);
  const uint segments = (1u << lanes) - 1u;
  if (joints == W_JOINTS_CAPSULE) leaf[W_LEAF_LAYOUT] = layout | W_LAYOUT_CAPSULES;
  leaf[W_LEAF_CUTS] = (cut_joints & segments) | (cut_joints >> n & segments) << 16;
  leaf[W_LEAF_SPHERES] = joints == W_JOINTS_OPEN
                             ? 0u
                             : (cut_joints & segments) | (open_end ? cut_joints >> lanes << (16 + lanes - n) : 0u);
  return box;
}

/* Run i of a buffer of leaves whose first leaf has the number `base`. */
W_INLINE uint4 run_in_buffer(__global const uint4* runs, uint i, uint base) {
  uint4 run = runs[i];
  run.x -= base;
  return run;
}

/* Measures of the leaves of one buffer (W_STEP_*), before they are packed: zeros before the first. Numbers alone count:
   others are refused once packed. */
__kernel void measure_leaves(__global const uint4* runs, __global const float* positions,
                             __global const uint* leaves, uint base, uint first, uint count, __global uint* steps) {
  const uint i = first + get_global_id(0);
  if (i - first >= count) return;
  const uint4 run = run_in_buffer(runs, i, base);
  __global const uint* leaf = leaves + ((size_t)run.x << 2);
  const uint layout = leaf[W_LEAF_LAYOUT], n = layout & 255u, intervals = ((layout >> 8) & 255u) / n;
  const int before = (int)(leaf[W_LEAF_SEGMENT] - run.y) - 1;
  float3 lo = (float3)(FLT_MAX), hi = (float3)(-FLT_MAX);
  for (uint p = 0; p < n; ++p) {
    Ply ply;
    ply.vertices = positions + ((size_t)run.y + (size_t)p * run.z) * 3;
    ply.count = (int)run.z;
    ply.ghosts = (int)run.w;
    for (int j = 0; j < (int)intervals + 3; ++j) {
      const float3 x = vertex(&ply, before + j);
      lo = fmin(lo, x);
      hi = fmax(hi, x);
    }
  }
  const float3 side = hi - lo, far = fmax(fabs(lo), fabs(hi));
  __global uint* out = steps + steps_of(leaf);
  atomic_max(out + W_STEP_EXTENT, as_uint(clamp(fmax(side.x, fmax(side.y, side.z)), 0.0f, FLT_MAX)));
  atomic_max(out + W_STEP_REACH, as_uint(fmin(fmax(far.x, fmax(far.y, far.z)), FLT_MAX)));
}

/* Runs first .. first + count - 1 are those of one buffer of leaves. boxes: lo x,y,z, hi x,y,z. */
__kernel void pack_leaves(__global const uint4* runs, __global const float* positions, __global uint* leaves, uint base,
                          uint first, uint count, uint joints, __global float* boxes,
                          __global const uint* steps) {
  const uint i = first + get_global_id(0);
  if (i - first >= count) return;
  const Bounds box = pack_leaf(run_in_buffer(runs, i, base), positions, joints, steps, leaves);
  vstore3(box.lo, 2 * (size_t)i, boxes);
  vstore3(box.hi, 2 * (size_t)i + 1, boxes);
}

/* Tells the leaves of one buffer, of numbers `base` to `base + numbers`, where the tree holds them; procedural leaves
   have no word for it. */
__kernel void place_leaves(__global const uint* nodes, __global uint* leaves, uint base, uint numbers, uint count) {
  const uint place = get_global_id(0), node = place / W_NODE_WIDTH;
  if (node >= count) return;
  const uint code = nodes[(size_t)node * W_NODE_WORDS + W_NODE_CHILD + place % W_NODE_WIDTH];
  const uint number = (code & ~W_CHILD_LEAF) - base;
  if (code == W_NONE || !(code & W_CHILD_LEAF) || number >= numbers) return;
  leaves[((size_t)number << 2) + W_LEAF_PLACE] = place;
}

/* Packs again and writes each leaf's box where the tree holds it. Widened as by build_wide_tree. */
__kernel void refit_leaves(__global const uint4* runs, __global const float* positions, __global uint* leaves,
                           uint base, uint first, uint count, uint joints, __global float* nodes,
                           __global const uint* steps) {
  const uint i = first + get_global_id(0);
  if (i - first >= count) return;
  const uint4 run = run_in_buffer(runs, i, base);
  const Bounds box = pack_leaf(run, positions, joints, steps, leaves);
  const float3 lo = box.lo - (fabs(box.lo) * 4.8e-7f + 1e-30f), hi = box.hi + (fabs(box.hi) * 4.8e-7f + 1e-30f);
  const uint place = leaves[((size_t)run.x << 2) + W_LEAF_PLACE];
  __global float* f = nodes + (size_t)(place / W_NODE_WIDTH) * W_NODE_WORDS + place % W_NODE_WIDTH;
  f[0] = lo.x;
  f[16] = lo.y;
  f[32] = lo.z;
  f[48] = hi.x;
  f[64] = hi.y;
  f[80] = hi.z;
}

/* Nodes [first, first + count) of one level write their bounds where their parents hold them; below them all is done.
   Empty children do not count: their boxes are inside out. */
__kernel void refit_nodes(__global float* nodes, uint first, uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  __global const float* f = nodes + (size_t)(first + i) * W_NODE_WORDS;
  const uint place = as_uint(f[W_NODE_PLACE]);
  __global float* out = nodes + (size_t)(place / W_NODE_WIDTH) * W_NODE_WORDS + place % W_NODE_WIDTH;
  for (uint side = 0; side < 6; ++side, f += W_NODE_WIDTH, out += W_NODE_WIDTH) {
    float m = f[0];
    for (uint slot = 1; slot < W_NODE_WIDTH; ++slot) m = side < 3 ? fmin(m, f[slot]) : fmax(m, f[slot]);
    *out = m;
  }
}
