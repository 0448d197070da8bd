/* Each pixel's owner adds its slots in the order of samples: the picture does not depend on the pool's size, on queue
   order or on threads. Sample s belongs to scramble s % W_SCRAMBLES; the spread of the scrambles gives the variance. */
#include "sampling/sobol.clh"
#include "shared/real.clh"
#include "stages/path_state.clh"

/* A sample so bright that the sum of as many would overflow counts as not finite. */
#define W_SUM_HEADROOM 1e5f

/* Adds the wave's pixels to those of the film's band [band_first, band_first + band_pixels) of pixel numbers. */
__kernel void accumulate(WFrame frame, WCamera camera, __global const uint* wave_tiles, uint band_first,
                         uint band_pixels, __global const float4* radiance, __global float4* film,
                         __global uint* events) {
  const uint g = get_global_id(0);
  if (g >= frame.paths / frame.samples_in_wave) return;
  const uint pixel = w_wave_pixel(wave_tiles, g), in_band = pixel - band_first;
  if (in_band >= band_pixels) return;
  int x, y;
  if (!w_pixel_xy(pixel, camera.width, camera.height, &x, &y)) return;
  __global float4* out = film + (ulong)in_band * W_SCRAMBLES;
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
