/* Shadow rays: what was sampled on a light arrives unless something is in the way. Plies in the way let the uncollided
   part of the light through by the same rule as on path rays. */
#include "geometry/traverse.clh"
#include "sampling/dimensions.clh"
#include "stages/ask_ahead.clh"
#include "stages/load_hit.clh"
#include "stages/path_state.clh"
#include "stages/scene_args.clh"

W_CALL int w_connects(const WScene* scene, const WRay* ray) { return !w_occluded(scene, ray); }

__kernel void connect(WFrame frame, W_PATH_PARAMS, W_SCENE_PARAMS, __global const uint* list,
                      __global const uint* counts, uint count_index, uint depth) {
  const uint i = get_global_id(0);
  const uint count = counts[count_index];
  if (i >= count) return;
  const uint slot = list[i];
  const WScene scene = W_SCENE;
  w_ask_for_start(&scene, shadow_l, list, i, count);
  WRay ray = w_slot_ray(shadow_o, shadow_l, shadow_d, slot);
  ray.tmax = shadow_d[slot].w;
  const uint pixel = w_slot_pixel(&frame, wave_tiles, slot);
  ray.key = w_shadow_key(pixel, w_slot_sample(&frame, slot), depth, frame.seed, frame.opaque_shadows);
  if (!w_connects(&scene, &ray)) return;
  radiance[slot].xyz += shadow_c[slot].xyz;
#ifdef W_GRADIENTS
  for (uint k = slot * W_GRADIENT_COUNT; k < (slot + 1) * W_GRADIENT_COUNT; ++k)
    gradient[k].xyz += shadow_gradient[k].xyz;
#endif
}
