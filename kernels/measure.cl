/* What a device can move and compute at best: the floors that stages are measured against. */
#include "shared/lanes.clh"

__kernel void copy(__global const float4* from, __global float4* to, uint count) {
  for (uint i = get_global_id(0); i < count; i += get_global_size(0)) to[i] = from[i];
}

/* W_CHAINS independent chains of fused multiply-adds hide their latency. */
#define W_CHAINS 16
__kernel void multiply_add(__global float* out, uint rounds) {
  w_vf x[W_CHAINS];
  const w_vf a = w_all(R(0.999)), b = w_all(R(1e-3) * (w_real)(get_global_id(0) & 7u));
#pragma unroll
  for (uint k = 0; k < W_CHAINS; ++k) x[k] = w_all((w_real)k);
  for (uint r = 0; r < rounds; ++r) {
#pragma unroll
    for (uint k = 0; k < W_CHAINS; ++k) x[k] = fma(x[k], a, b);
  }
  w_vf sum = x[0];
#pragma unroll
  for (uint k = 1; k < W_CHAINS; ++k) sum += x[k];
  w_real lanes[W_LANES];
  w_store(sum, lanes);
  out[get_global_id(0)] = lanes[0];
}
