/* Paths that leave the scene gather the environment and end. */
#include "lights.clh"
#include "stages/light_args.clh"
#include "stages/path_state.clh"

__kernel void miss(WFrame frame, W_PATH_PARAMS, W_LIGHT_PARAMS, __global float4* aov, __global const uint* list,
                   __global const uint* counts, uint count_index) {
  const uint i = get_global_id(0);
  if (i >= counts[count_index]) return;
  const uint slot = list[i];
  mask[slot] = 0u;
#ifdef W_AOVS
  if (ray_d[slot].w < 0.0f) {  // from the camera: the slot still holds what an earlier wave met
    __global float4* a = aov + (ulong)slot * 4;
    a[0] = a[1] = a[2] = (float4)(0.0f);
    a[3] = (float4)(0.0f, 0.0f, 0.0f, as_float(W_NONE));
  }
#endif
#ifdef W_HAS_ENVIRONMENT
  const WLights lights = W_LIGHTS;
  const w_real3 d = w_real3_of(ray_d[slot]);
  const float density = ray_d[slot].w;
  w_real share = R(1.0);  // of the two ways to arrive here, light and BSDF sampling
  if (density >= 0.0f) {
    if (frame.light_sampling == 1) return;
    if (frame.light_sampling == 0) share = w_mis(density, w_environment_pdf(&lights, d));
  }
  const w_real3 c = w_real3_of(weight[slot]) * w_environment_radiance(&lights, d) * share;
  radiance[slot].xyz += w_float3(c);
  W_ADD_GRADIENTS(slot, c)
#endif
}
