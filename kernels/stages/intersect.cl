/* Nearest hit of every live path: global stage down the tree over cells, local stage on their plies. */
#include "geometry/traverse.clh"
#include "stages/load_hit.clh"
#include "stages/path_state.clh"
#include "stages/scene_args.clh"
#include "sampling/dimensions.clh"

__kernel void intersect(WFrame frame, W_PATH_PARAMS, W_SCENE_PARAMS, __global const uint* list,
                        __global const uint* counts, uint count_index, uint depth) {
  const uint i = get_global_id(0);
  if (i >= counts[count_index]) return;
  const uint slot = list[i];
  const WScene scene = W_SCENE;
  WRay ray = w_slot_ray(ray_o, ray_l, ray_d, slot);
  ray.tmax = 1e30f;
  ray.key = w_ray_key(w_slot_pixel(&frame, slot), w_slot_sample(&frame, slot), depth, W_RAY_PATH, frame.seed);
  const WHit h = w_closest(&scene, &ray);
  hit[slot] = (uint4)(as_uint(h.t), h.kind, h.code, 0u);
  hit_uv[slot] = (float2)(h.u, h.v);
#ifdef W_HAS_PLIES
  if (h.kind == W_HIT_PLY && h.v != (float)W_PIECE_SIDE) atomic_inc(events + W_EVENT_SPHERE);
#endif
  uint bin = h.kind == W_HIT_NONE ? W_BIN_MISS : h.kind == W_HIT_PLY ? W_BIN_PLY : W_BIN_SURFACE;
#ifdef W_HAS_FIBRES
  if (bin == W_BIN_PLY && (w_leaf(&scene, h.code >> 4).head[W_LEAF_MATERIAL] & W_MATERIAL_FIBRE))
    bin = W_BIN_FIBRE;
#endif
  mask[slot] = bin;
}
