/* Nearest hits of camera rays, W_LANES neighbours at a time: the same hits as intersect.cl's. */
#include "geometry/traverse_packet.clh"
#include "stages/path_hit.clh"
#include "stages/scene_args.clh"

W_CALL void w_meet_packet(const WScene* scene, const WRay* rays, uint count, WPacket* packet) {
  w_closest_packet(scene, rays, count, packet);
}

__kernel void intersect_packets(WFrame frame, W_PATH_PARAMS, W_SCENE_PARAMS, __global const uint* list,
                                __global const uint* counts, uint count_index, uint depth) {
  const uint first = get_global_id(0) * W_LANES, end = counts[count_index];
  if (first >= end) return;
  const uint count = min(end - first, (uint)W_LANES);
  const WScene scene = W_SCENE;
  WRay rays[W_LANES];
  for (uint i = 0; i < count; ++i)
    rays[i] = w_path_ray(&frame, ray_o, ray_l, ray_d, wave_tiles, list[first + i], depth);
  WPacket packet;
  w_meet_packet(&scene, rays, count, &packet);
  for (uint i = 0; i < count; ++i) {
    const WHit h = w_packet_hit(&packet, i);
    W_STORE_HIT(&scene, list[first + i], h)
  }
}
