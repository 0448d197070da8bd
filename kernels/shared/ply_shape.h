#ifndef W_SHARED_PLY_SHAPE_H
#define W_SHARED_PLY_SHAPE_H
/* Shape of a ply's body lobes, one home for the kernels, the thick layer of the host and the goniometer's model.
   Measured on six bundles of fibres, at normal and oblique incidence (bench/results/goniometer.md). Written as floats, so
   that every reader means the same number. */
#define W_BODY_LEAN 0.75f       /* lean of the body's axis, per tangent of the surface fibres' angle and offset */
#define W_BODY_LEAN_DECAY 2.25f /* how much less comes back where that axis leans to the viewer */
#define W_BODY_GRAZE 3.5f       /* how much more at grazing angles */
#define W_FORWARD_LEAST 0.25f   /* least scale of lobe F */
#define W_FORWARD_SKEW 0.35f    /* and its skew, per offset */
#endif
