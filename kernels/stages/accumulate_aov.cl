#include "stages/path_state.clh"

/* First-hit features: sums over samples of 4 x float4 per pixel, the last w counts the samples that met something;
   and the ply of the pixel's first sample. Arguments as in accumulate; `shift` is added to positions that were met. */
__kernel void accumulate_aov(WFrame frame, WCamera camera, __global const uint* wave_tiles, uint band_first,
                             uint band_pixels, __global const float4* aov, __global float4* film,
                             __global uint* ply, float4 shift) {
  const uint g = get_global_id(0);
  if (g >= frame.paths / frame.samples_in_wave) return;
  const uint number = w_wave_pixel(wave_tiles, g), in_band = number - band_first;
  if (in_band >= band_pixels) return;
  int x, y;
  if (!w_pixel_xy(number, camera.width, camera.height, &x, &y)) return;
  const ulong pixel = (ulong)in_band;
  for (uint k = 0; k < frame.samples_in_wave; ++k) {
    __global const float4* in = aov + ((ulong)g * frame.samples_in_wave + k) * 4;
    if (frame.samples_before + k == 0) ply[pixel] = as_uint(in[3].w);
    film[pixel * 4] += in[0];
    film[pixel * 4 + 1] += in[1];
    film[pixel * 4 + 2] += in[2];
    film[pixel * 4 + 3] += in[0].w > 0.0f ? (float4)(in[3].xyz + shift.xyz, 1.0f) : (float4)(in[3].xyz, 0.0f);
  }
}
