#ifndef WALE_SHARED_JOINTS_H
#define WALE_SHARED_JOINTS_H
/* How segments of a ply meet, decided where leaves are packed (geometry/joint.clh): rays read cuts and spheres alone. */
#define W_JOINTS_OPEN 0    /* cut square: gaps outside of every bend, overlaps inside, open ends */
#define W_JOINTS_CAPSULE 1 /* cut square, a sphere at every joint: watertight, its silhouette has corners */
#define W_JOINTS_MITRE 2   /* cut by the bisecting plane; square with a sphere where that does not fit, and at ends */
/* In W_LEAF_LAYOUT, beside its S: every joint of these plies has a sphere. */
#define W_LAYOUT_CAPSULES 0x80000000u
#define W_LAYOUT_STRIDE(layout) ((layout) >> 16 & 0x3fffu)
#endif
