/* Nearest hit of every live path: global stage down the tree over cells, local stage on their plies. */
#include "geometry/traverse.clh"
#include "stages/ask_ahead.clh"
#include "stages/path_hit.clh"
#include "stages/scene_args.clh"

W_CALL void w_meet(const WScene* scene, const WRay* ray, WHit* h) { *h = w_closest(scene, ray); }

__kernel void intersect(WFrame frame, W_PATH_PARAMS, W_SCENE_PARAMS, __global const uint* list,
                        __global const uint* counts, uint count_index, uint depth) {
  const uint i = get_global_id(0);
  const uint count = counts[count_index];
  if (i >= count) return;
  const uint slot = list[i];
  const WScene scene = W_SCENE;
  w_ask_for_start(&scene, ray_l, list, i, count);
  const WRay ray = w_path_ray(&frame, ray_o, ray_l, ray_d, wave_tiles, slot, depth);
  WHit h;
  w_meet(&scene, &ray, &h);
  W_STORE_HIT(&scene, slot, h)
}
