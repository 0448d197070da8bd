/* Each pixel's owner adds its slots in the order of samples: the picture does not depend on the pool's size, on queue
   order or on threads. Sample s belongs to scramble s % W_SCRAMBLES; the spread of the scrambles gives the variance. */
#include "sampling/sobol.clh"
#include "shared/real.clh"
#include "stages/path_state.clh"

/* A sample so bright that the sum of as many would overflow counts as not finite. */
#define W_SUM_HEADROOM 1e5f

/* Adds `pixels` pixels of the wave, from its pixel `first` on, to the film's from film_first on; both are in the order
   of pixel numbers. */
__kernel void accumulate(WFrame frame, WCamera camera, uint first, uint film_first, uint pixels,
                         __global const float4* radiance, __global float4* film, __global uint* events) {
  const uint i = get_global_id(0), g = first + i;
  if (i >= pixels) return;
  int x, y;
  if (!w_pixel_xy(frame.first_pixel + g, camera.width, camera.height, &x, &y)) return;
  __global float4* out = film + (ulong)(film_first + i) * W_SCRAMBLES;
  for (uint k = 0; k < frame.samples_in_wave; ++k) {
    float4 value = radiance[g * frame.samples_in_wave + k];
    value.w = 1.0f;
    if (!w_all_finite(value * W_SUM_HEADROOM)) {
      atomic_inc(events + W_EVENT_NAN);
      value = (float4)(0.0f, 0.0f, 0.0f, 1.0f);
    }
    out[(frame.samples_before + k) % W_SCRAMBLES] += value;
  }
}
