/* Shadow rays: what was sampled on a light arrives unless something is in the way. Plies in the way let the uncollided
   part of the light through by the same rule as on path rays. */
#include "geometry/traverse.clh"
#include "stages/path_state.clh"
#include "stages/scene_args.clh"
#include "sampling/dimensions.clh"

__kernel void connect(WFrame frame, W_PATH_PARAMS, W_SCENE_PARAMS, __global const uint* list,
                      __global const uint* counts, uint count_index, uint depth) {
  const uint i = get_global_id(0);
  if (i >= counts[count_index]) return;
  const uint slot = list[i];
  const WScene scene = W_SCENE;
  const float4 o = shadow_o[slot], l = shadow_l[slot], d = shadow_d[slot];
  WRay ray;
  ray.o = o.xyz;
  ray.l = l.xyz;
  ray.d = d.xyz;
  ray.tmax = d.w;
  ray.key = w_ray_key(w_slot_pixel(&frame, slot), w_slot_sample(&frame, slot), depth, W_RAY_SHADOW, frame.seed);
  ray.skip = as_uint(l.w);
  ray.skip_triangle = as_uint(o.w);
  if (!w_occluded(&scene, &ray)) radiance[slot].xyz += shadow_c[slot].xyz;
}
