/* Stable compaction by prefix sums in three launches without barriers: counts per chunk, scan of the counts, scatter.
   A slot may lie in several bins. The fourth exists where single fibres are
   shaded. Order of slots is kept, so results never depend on scheduling. */
#include "shared/wale_types.h"
#define W_CHUNK 256
#ifdef W_HAS_FIBRES
#define W_BINS 4
#else
#define W_BINS 3
#endif

__kernel void compact_count(__global const uint* list, __global const uint* mask, __global const uint* counts,
                            uint count_index, __global uint* chunk) {
  const uint n = counts[count_index];
  const uint c = get_global_id(0);
  if (c * W_CHUNK >= n) return;
  const uint end = min(n, (c + 1) * W_CHUNK);
  uint bins[W_BINS];
  for (uint b = 0; b < W_BINS; ++b) bins[b] = 0;
  for (uint i = c * W_CHUNK; i < end; ++i) {
    const uint m = mask[list[i]];
    for (uint b = 0; b < W_BINS; ++b) bins[b] += (m >> b) & 1u;
  }
  for (uint b = 0; b < W_BINS; ++b) chunk[c * W_BINS + b] = bins[b];
}

__kernel void compact_scan(__global uint* counts, uint count_index, uint total_index, __global uint* chunk) {
  if (get_global_id(0) != 0) return;
  const uint chunks = (counts[count_index] + W_CHUNK - 1) / W_CHUNK;
  uint sum[W_BINS];
  for (uint b = 0; b < W_BINS; ++b) sum[b] = 0;
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
                              __global uint* out2
#ifdef W_HAS_FIBRES
                              , __global uint* out3
#endif
) {
  const uint n = counts[count_index];
  const uint c = get_global_id(0);
  if (c * W_CHUNK >= n) return;
  const uint end = min(n, (c + 1) * W_CHUNK);
  uint at0 = chunk[c * W_BINS], at1 = chunk[c * W_BINS + 1], at2 = chunk[c * W_BINS + 2];
#ifdef W_HAS_FIBRES
  uint at3 = chunk[c * W_BINS + 3];
#endif
  for (uint i = c * W_CHUNK; i < end; ++i) {
    const uint slot = list[i], m = mask[slot];
    if (m & 1u) out0[at0++] = slot;
    if (m & 2u) out1[at1++] = slot;
    if (m & 4u) out2[at2++] = slot;
#ifdef W_HAS_FIBRES
    if (m & 8u) out3[at3++] = slot;
#endif
  }
}
