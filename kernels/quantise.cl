/* Quantised nodes and leaf boxes from the 16-wide nodes that were built or refitted; a work-item makes one node. */
#pragma OPENCL FP_CONTRACT OFF
#include "shared/wale_types.h"

/* The very plane that traverse_simt.clh finds. */
static inline float plane_of(uint q, float scale, float origin) { return fma((float)q, scale, origin); }

/* Smallest power of two, as an exponent E (wale_types.h), with which 255 steps from `lo` reach `hi`. */
static inline uint exponent_of(float lo, float hi) {
  uint e = clamp(as_uint((hi - lo) / 255.0f) >> 23, 1u, 254u);
  while (e < 254u && plane_of(255u, as_float(e << 23), lo) < hi) ++e;
  return e;
}

static inline uint step_below(float x, float scale, float origin) {
  uint q = min((uint)((x - origin) / scale), 255u);
  while (q > 0u && plane_of(q, scale, origin) > x) --q;
  return q;
}

static inline uint step_above(float x, float scale, float origin) {
  uint q = min((uint)((x - origin) / scale), 255u);
  while (q < 255u && plane_of(q, scale, origin) < x) ++q;
  return q;
}

/* first_leaf: number of the node's first leaf box. */
__kernel void quantise_nodes(__global const uint* nodes, __global const uint* first_leaf, __global uint* quantised,
                             __global uint* leaf_boxes, uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  __global const uint* node = nodes + (size_t)i * W_NODE_WORDS;
  __global const float* f = (__global const float*)node;
  __global uint* out = quantised + (size_t)i * W_QUANTISED_WORDS;
  uint slots = 0, first_node = 0, leaf = first_leaf[i];
  for (uint slot = 0; slot < W_NODE_WIDTH; ++slot) {
    const uint code = node[W_NODE_CHILD + slot];
    if (code == W_NONE) continue;
    slots |= 1u << slot;
    if (!(code & W_CHILD_LEAF)) {
      if (!(slots >> 16)) first_node = code & W_CHILD_INDEX;
      slots |= 0x10000u << slot;
      continue;
    }
    __global uint* box = leaf_boxes + (size_t)leaf++ * W_LEAF_BOX_WORDS;
    for (uint k = 0; k < 3; ++k) {
      box[k] = node[16 * k + slot];
      box[4 + k] = node[48 + 16 * k + slot];
    }
    box[3] = code & ~W_CHILD_LEAF;
    box[7] = 0u;
  }
  out[W_QUANTISED_FIRST_NODE] = first_node;
  out[W_QUANTISED_FIRST_LEAF] = first_leaf[i];
  out[W_QUANTISED_SLOTS] = slots;
  out[7] = 0u;
  uint exponents = 0;
  for (uint k = 0; k < 3; ++k) {
    float lo = 1e30f, hi = -1e30f; /* as in slots that hold nothing */
    for (uint slot = 0; slot < W_NODE_WIDTH; ++slot) {
      lo = fmin(lo, f[16 * k + slot]);
      hi = fmax(hi, f[48 + 16 * k + slot]);
    }
    const uint e = exponent_of(lo, hi);
    const float scale = as_float(e << 23);
    exponents |= e << (8 * k);
    out[W_QUANTISED_ORIGIN + k] = as_uint(lo);
    for (uint word = 0; word < 4; ++word) {
      uint below = 0, above = 0;
      for (uint byte = 0; byte < 4; ++byte) {
        const uint slot = 4 * word + byte;
        if (!(slots >> slot & 1u)) continue;
        below |= step_below(f[16 * k + slot], scale, lo) << (8 * byte);
        above |= step_above(f[48 + 16 * k + slot], scale, lo) << (8 * byte);
      }
      out[W_QUANTISED_PLANES + 4 * k + word] = below;
      out[W_QUANTISED_PLANES + 12 + 4 * k + word] = above;
    }
  }
  out[W_QUANTISED_EXPONENTS] = exponents;
}
