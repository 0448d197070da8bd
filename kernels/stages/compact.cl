/* Stable compaction by prefix sums in three launches without barriers: counts per chunk, scan of the counts, scatter.
   A slot may lie in several of the three bins. Order of slots is kept, so results never depend on scheduling. */
#include "shared/wale_types.h"
#define W_CHUNK 256
#define W_BINS 3

__kernel void compact_count(__global const uint* list, __global const uint* mask, __global const uint* counts,
                            uint count_index, __global uint* chunk) {
  const uint n = counts[count_index];
  const uint c = get_global_id(0);
  if (c * W_CHUNK >= n) return;
  const uint end = min(n, (c + 1) * W_CHUNK);
  uint bins[W_BINS] = {0, 0, 0};
  for (uint i = c * W_CHUNK; i < end; ++i) {
    const uint m = mask[list[i]];
    bins[0] += m & 1u;
    bins[1] += (m >> 1) & 1u;
    bins[2] += (m >> 2) & 1u;
  }
  for (uint b = 0; b < W_BINS; ++b) chunk[c * W_BINS + b] = bins[b];
}

__kernel void compact_scan(__global uint* counts, uint count_index, uint total_index, __global uint* chunk) {
  if (get_global_id(0) != 0) return;
  const uint chunks = (counts[count_index] + W_CHUNK - 1) / W_CHUNK;
  uint sum[W_BINS] = {0, 0, 0};
  for (uint c = 0; c < chunks; ++c)
    for (uint b = 0; b < W_BINS; ++b) {
      const uint here = chunk[c * W_BINS + b];
      chunk[c * W_BINS + b] = sum[b];
      sum[b] += here;
    }
  for (uint b = 0; b < W_BINS; ++b) counts[total_index + b] = sum[b];
}

__kernel void compact_scatter(__global const uint* list, __global const uint* mask, __global const uint* counts,
                              uint count_index, __global const uint* chunk, __global uint* out0, __global uint* out1,
                              __global uint* out2) {
  const uint n = counts[count_index];
  const uint c = get_global_id(0);
  if (c * W_CHUNK >= n) return;
  const uint end = min(n, (c + 1) * W_CHUNK);
  uint at0 = chunk[c * W_BINS], at1 = chunk[c * W_BINS + 1], at2 = chunk[c * W_BINS + 2];
  for (uint i = c * W_CHUNK; i < end; ++i) {
    const uint slot = list[i], m = mask[slot];
    if (m & 1u) out0[at0++] = slot;
    if (m & 2u) out1[at1++] = slot;
    if (m & 4u) out2[at2++] = slot;
  }
}
