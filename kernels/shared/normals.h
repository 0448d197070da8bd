#ifndef WALE_SHARED_NORMALS_H
#define WALE_SHARED_NORMALS_H
/* Frames that the sides of plies are shaded with (geometry/ply_surface.clh). Sides and ray starts are geometric always. */
#define W_NORMALS_FLAT 0   /* the segment's own: facets show where plies bend */
#define W_NORMALS_LINEAR 1 /* axis between the joints' mean directions, the normal set square to it */
#define W_NORMALS_ROTATION_MINIMISING 2 /* axis and normal between those of the joints, carried there by least rotations */
#endif
