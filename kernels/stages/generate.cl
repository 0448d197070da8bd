/* Camera rays of one wave: slot -> (pixel, sample), see path_state.clh. */
#include "camera.clh"
#include "sampling/dimensions.clh"
#include "sampling/sobol.clh"
#include "stages/path_state.clh"

__kernel void generate(WFrame frame, WCamera camera, W_PATH_PARAMS, __global uint* list, __global uint* counts) {
  const uint slot = get_global_id(0);
  if (slot == 0) counts[0] = frame.paths;
  if (slot >= frame.paths) return;
  list[slot] = slot;
  radiance[slot] = (float4)(0.0f);
  weight[slot] = (float4)(1.0f);
#ifdef W_GRADIENTS
  for (uint k = slot * W_GRADIENT_COUNT; k < (slot + 1) * W_GRADIENT_COUNT; ++k) score[k] = gradient[k] = (float4)(0.0f);
#endif
  const uint pixel = w_slot_pixel(&frame, wave_tiles, slot);
  int x, y;
  const int inside = w_pixel_xy(pixel, camera.width, camera.height, &x, &y);
  mask[slot] = inside ? W_BIN_ALIVE : 0u;
  if (!inside) return;
  const WSampler sampler = w_sampler(pixel, w_slot_sample(&frame, slot), frame.seed);
  const float4 u = w_sample4(&sampler, W_SET_CAMERA);
  w_real3 origin, direction;
  w_camera_ray(camera, x, y, u, &origin, &direction);
  ray_o[slot] = (float4)(w_float3(origin), as_float(W_NONE));
  ray_l[slot] = (float4)(0.0f, 0.0f, 0.0f, as_float(W_NONE));
  ray_d[slot] = (float4)(w_float3(direction), -1.0f);
}
