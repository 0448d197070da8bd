#ifndef WALE_SHARED_VERTICES_H
#define WALE_SHARED_VERTICES_H
/* How stored leaves keep their points: floats (wale_types.h), or 16 bits a coordinate. Quantised, four words follow the
   header, then the points as ushorts q, x[S], y[S], z[S] with S a multiple of 8: a coordinate is (origin + q) * step.
   The step is a power of two, the same in all leaves of a kind of curve (plies, single fibres) of a fabric, and origins
   count in steps: a point is rounded to the lattice of whole steps about the scene's origin, which knows of no leaf, so
   that leaves that share a joint hold the same point. The product is exact: either |origin + q| < 2^24, or the step is
   finer than the floats that were rounded. */
#define W_VERTICES_FULL 0
#define W_VERTICES_QUANTISED 1
#define W_LAYOUT_QUANTISED 0x40000000u /* in W_LEAF_LAYOUT, for those who pack */
#define W_LEAF_ORIGIN 12               /* ints x, y, z */
#define W_LEAF_STEP 15                 /* float, metres */
#define W_QUANTISED_LEAF_HEADER 16
#define W_QUANTISED_EXTENT 65532.0f    /* most steps across a leaf: two more are lost to rounding */
#define W_QUANTISED_REACH 0x1p30f      /* most steps from the scene's origin */
/* Measures that steps follow from, W_STEP_WORDS for plies and then for fibres of each fabric: bits of floats, which are
   in the order of what they stand for. */
#define W_STEP_WORDS 2
#define W_STEP_EXTENT 0 /* largest side of a leaf's box of points */
#define W_STEP_REACH 1  /* largest coordinate */
#endif
