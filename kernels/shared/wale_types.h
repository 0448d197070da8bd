#ifndef WALE_TYPES_H
#define WALE_TYPES_H
/* Types and layouts shared by host (C++20) and kernels (OpenCL C 1.2): 4-byte scalars and 4-vectors only. Sizes are
   checked on the host below and, on the device, by the test `TypeLayout`. Lengths in metres relative to the scene
   origin that the host subtracts; angles in radians; radiance in scene-linear Rec. 709. */

#ifdef __OPENCL_VERSION__
typedef float4 w_float4;
typedef uint w_uint;
typedef int w_int;
#else
#include <cstdint>
struct alignas(16) w_float4 {
  float x, y, z, w;
};
typedef uint32_t w_uint;
typedef int32_t w_int;
#endif

#define W_NONE 0xffffffffu

/* --- tree ---------------------------------------------------------------------------------------------------------
   Node: 7 arrays of 16 words: lo x,y,z, hi x,y,z (floats; empty children have lo = +1e30, hi = -1e30), child code;
   then its own place, 16 * parent + slot there (W_NONE: the root), and words not used.
   Child code: W_NONE empty; W_CHILD_LEAF | offset of the leaf in 16-byte units; else node index, with
   W_CHILD_CELL set where that node is the root of one UV cell. */
#define W_NODE_WIDTH 16
#define W_NODE_WORDS 128
#define W_NODE_CHILD 96
#define W_NODE_PLACE 112
#define W_CHILD_LEAF 0x80000000u
#define W_CHILD_CELL 0x40000000u
#define W_CHILD_INDEX 0x3fffffffu

/* --- quantised node, for one ray per work-item (traverse_simt.clh) -------------------------------------------------------
   One W_NODE_WORDS node in 128 bytes, a line of a GPU's cache; nodes keep their numbers. Plane q of axis k lies at
   fma(q, 2^(E_k - 127), origin_k), rounded as float is: that value, not the real one, is outside of the exact plane.
   Inner children, in the order of their slots, are node FIRST_NODE and what follows; leaves are leaf boxes FIRST_LEAF
   and what follows. */
#define W_QUANTISED_WORDS 32
#define W_QUANTISED_ORIGIN 0     /* x, y, z, floats */
#define W_QUANTISED_EXPONENTS 3  /* E_x | E_y << 8 | E_z << 16 */
#define W_QUANTISED_FIRST_NODE 4
#define W_QUANTISED_FIRST_LEAF 5
#define W_QUANTISED_SLOTS 6      /* bit s: slot s holds a child; bit 16+s: that is a node */
#define W_QUANTISED_PLANES 8     /* 16 bytes each of lo x,y,z, hi x,y,z */
/* Leaf box: lo x,y,z, offset of the leaf in 16-byte units, hi x,y,z, 0; the very planes of the tree's node. */
#define W_LEAF_BOX_WORDS 8

/* --- patch leaf (plies) --------------------------------------------------------------------------------------------
   `intervals` consecutive segments of all n plies of one yarn. Lane l = k*n + p is segment k of ply p. Header of
   W_LEAF_HEADER words, then x[S], y[S], z[S] of the points: point (k, p) at index k*n + p for k = 0 .. intervals+2,
   where k = 0 is the vertex before the first segment, so that lane l finds its four points (previous, start, end,
   next) at l, l+n, l+2n, l+3n. S = (intervals+3)*n rounded up to a multiple of 4; masked lanes read what follows, and
   the buffer ends in words that no leaf owns. Missing neighbours at open ends repeat the end vertex. */
#define W_LEAF_LANES 16
#define W_LEAF_BUFFERS 8 /* most buffers that leaves are spread over, where one may not hold them */
#define W_LEAF_HEADER 12
#define W_LEAF_RADIUS 0   /* float, metres */
#define W_LEAF_SEGMENT 1  /* segment id of lane 0: the vertex id of its start */
#define W_LEAF_STRIDE 2   /* vertices per ply: segment id of lane (k,p) = SEGMENT + p*STRIDE + k */
#define W_LEAF_MATERIAL 3 /* ply material, or W_MATERIAL_FIBRE | fibre material */
#define W_LEAF_LAYOUT 4   /* n | lanes << 8 | S << 16 */
#define W_LEAF_CUTS 5     /* bit l: lane l starts at a perpendicular cut (sphere joint or cap); bit 16+l: ends at one */
#define W_LEAF_SPHERES 6  /* bit l: lane l owns the sphere at its start; bit 16+l: at its end */
#define W_LEAF_TAU 7      /* float, effective optical radius of the ply: pass-through exp(-2 tau cos gamma) */
#define W_LEAF_CELL 8     /* UV cell that owns the patch (global number) */
#define W_LEAF_FABRIC 9
#define W_LEAF_PLACE 10 /* where the tree holds it: 16 * node + slot */
#define W_LEAF_PLY 11  /* number of the run's first ply, over all fabrics */
/* Hit code of a ply segment: leaf offset (16-byte units) << 4 | lane. */

/* --- procedural leaf: no points are kept -----------------------------------------------------------------------------
   Leaf number W_LEAF_PROCEDURAL | v << patch bits | patch: v is the lattice vertex at the corner of a tile, `patch` an
   entry of the tile tables. A lattice vertex is P x,y,z, N x,y,z. An entry is W_PATCH_WORDS words: first a leaf's header,
   of which SEGMENT and PLY hold for tile (0,0) and PLACE means W_PATCH_ENDS, then what follows. The leaf's points are
     x_i = sum over controls c of rows[c][0][i] P_c + rows[c][1][i] N_c,
   control c being lattice vertex v + controls[c], rows of W_PATCH_POINTS floats at multiples of 64 bytes. */
#define W_LEAF_PROCEDURAL 0x08000000u
#define W_LATTICE_WORDS 6
#define W_PATCH_WORDS 32
#define W_PATCH_ENDS 10 /* bit 0: the first segment starts at an open end of the yarn; bit 1: the last one ends there */
#define W_PATCH_POINTS 32
#define W_PATCH_CONTROLS 12 /* word of the first of its control offsets (int, lattice words) */
#define W_PATCH_CONTROL_COUNT 13
#define W_PATCH_ROWS 14          /* word of its weights */
#define W_PATCH_VERTEX 15        /* word of the WTileVertex at the start of lane 0 */
#define W_PATCH_VERTEX_STRIDE 16 /* vertices per ply in that table */
#define W_PATCH_CORNER 17        /* lattice vertex at the corner of tile (0,0) */
#define W_PATCH_PITCH 18         /* lattice vertices per row of the lattice */
#define W_PATCH_CELLS 19         /* lattice cells along a tile's side */
#define W_PATCH_SEGMENT_COLUMN 20
#define W_PATCH_SEGMENT_ROW 21 /* segment ids to add per column and row of tiles */
#define W_PATCH_PLY_COLUMN 22
#define W_PATCH_PLY_ROW 23 /* and plies */
#define W_PATCH_AXIS 24    /* 0: its yarn goes on in the next column, 1: in the next row */

/* Vertex of a tile as a combination of the corners (0,0), (1,0), (0,1), (1,1) of one lattice cell (geom/tile_knit.h).
   Lengths count in 2^-32 of W_LENGTH_PERIOD radii, where they wrap. */
typedef struct WTileVertex {
  w_int cell;   /* first corner, in lattice words from the tile's corner */
  w_uint length, lap; /* of ply from the start of the tile's piece; of the whole piece */
  w_int up;     /* lattice words from corner (0,0) to (0,1) */
  float w[4], h[4], a[4], b[4];
} WTileVertex;

/* One yarn of a tile all over a cloth that is stored: a run of `plies` polylines of `count` vertices for every row
   (axis 0) or column of its tiles, one after the other from first_vertex on. */
typedef struct WLatticeRun {
  w_uint first_vertex, count, plies, ghosts; /* ghosts: 1 where it is closed, with a ghost end at either side */
  w_uint samples, tiles, axis, first_ply;    /* segments per tile; tiles along it */
  w_uint table, stride;                      /* word of its WTileVertex of ply 0, sample 0; those per ply */
  w_uint corner, pitch, cells;               /* as W_PATCH_* */
  float radius;
  w_uint pad0, pad1;
} WLatticeRun;

/* --- what a ply vertex keeps for shading: frame normal (unit) and rest length along the full ply, 4 floats, 16 bytes;
   where it lies is in the leaves. ------------------------------------------------------------------------------------
   The length starts anywhere (a hash of the ply, so that neighbours do not look alike) and wraps at W_LENGTH_PERIOD ply
   radii: a float then keeps the phase of the fibres to 1e-3 rad on any length of yarn. All that winds along a ply does so
   a whole number of times in one period (appearance/fibre_phase.clh). */
#define W_FRAME_WORDS 4
#define W_LENGTH_PERIOD 4096.0f

/* Colour of the segment that starts at a vertex, where colours vary: 10 bits q a channel from the lowest up,
   c = 1 - (1 - q/1023)^2. Without W_COLOR_GIVEN the material's own colour holds. */
#define W_COLOR_GIVEN 0x40000000u
#define W_COLOR_MAX 1023u

/* Marks a leaf whose curves are single fibres. */
#define W_MATERIAL_FIBRE 0x80000000u

/* --- triangle leaf (props, emissive meshes): header 4 words: first triangle, count, 0, 0; then v0 x,y,z [16],
   v1-v0 x,y,z [16], v2-v0 x,y,z [16]. Lane l is triangle first + l. -------------------------------------------------
 */
#define W_TRI_LEAF_WORDS 148

/* What a ray hit. */
#define W_HIT_NONE 0
#define W_HIT_PLY 1
#define W_HIT_TRIANGLE 2
#define W_HIT_SPHERE 3

/* Queues of the wavefront: what a path needs next. */
#define W_QUEUE_DONE 0
#define W_QUEUE_PLY 1
#define W_QUEUE_SURFACE 2
#define W_QUEUE_COUNT 3

/* Vertex of the flat knit tied to the base mesh (same as wale::Anchor). */
typedef struct WAnchor {
  w_uint triangle;
  float b1, b2, height;
  float nx, ny, nz, length;
} WAnchor;

/* Uniform UV grid of one chart (see geom/fabric.h). uv -> cell: (uv - origin) * inv_cell. */
typedef struct WGrid {
  w_uint first_cell;
  w_int nx, ny;
  w_int wrap_x;
  float origin_u, origin_v, inv_cell_u, inv_cell_v;
  w_int wrap_y, pad0, pad1, pad2;
} WGrid;

/* Ply BSDF parameters; names as in docs/appearance.md. */
typedef struct WPlyMaterial {
  w_float4 fibre;   /* rgb fibre colour C_f; w = 1 when forward and back give the body colours directly */
  w_float4 forward; /* rgb A_F when direct; w unused */
  w_float4 back;    /* rgb A_B when direct; w unused */
  float tau_e, f0, beta_r, e_r;
  float e_r_h4, b, s_f0, e_f;
  float d_f, s_b, d_b, v_c;
  float v_e, n0, n1, tilt; /* tilt = tan of the angle between surface fibres and the ply axis, signed */
  float hits_back, pad0, pad1, pad2; /* hits_back: fibre hits of lobe B's light per hit of lobe F's */
} WPlyMaterial;

/* Derivatives that a path gathers with W_GRADIENTS, an rgb each: by the body colours (of a channel by its own colour),
   by the highlight's width beta_r, radians, and by the fibres' tilt. */
#define W_GRADIENT_TRANSMIT 0
#define W_GRADIENT_REFLECT 1
#define W_GRADIENT_ROUGHNESS 2
#define W_GRADIENT_TILT 3
#define W_GRADIENT_COUNT 4

/* Fibre detail of one ply material (kernels/appearance/fibre_detail.clh). Lengths in ply radii unless said. */
#define W_DETAIL_BINS 64
#define W_DETAIL_NONE 0
#define W_DETAIL_PAPER 1 /* phase by the arc of the joint's ellipse, no migration, no filter: KNIT21 to the letter */
#define W_DETAIL_MAPS 2
typedef struct WFibreDetail {
  w_uint level;
  w_uint first_offset; /* of its W_DETAIL_BINS + 1 offsets into the candidates */
  float turns, wander; /* turns of the bundle, and migrations, per metre of ply */
  float fibre_radius, migration_min, twist, mean_distance;
  float inv_mean_openness, mean_openness, tilt_variance, pad0;
} WFibreDetail;

/* Far-field scattering of one fibre (docs/appearance.md): R at the surface, TT through it. */
typedef struct WFibreMaterial {
  w_float4 reflect;  /* rgb reflectance at normal incidence (Schlick) */
  w_float4 transmit; /* rgb colour of light that went through; w = 1: varying colours tint it */
  float beta_r, beta_tt; /* longitudinal widths, radians */
  float gamma_tt;        /* azimuthal width of TT, radians */
  float pad0;
} WFibreMaterial;

/* Materials of meshes. kind 0 diffuse, 1 diffuse under a rough dielectric coat (GGX). */
typedef struct WSurfaceMaterial {
  w_float4 color;    /* rgb diffuse albedo; w unused */
  w_float4 emission; /* rgb radiance, both sides unless one_sided; w unused */
  w_int kind;
  w_int light;     /* index of the light that this surface belongs to, or -1 */
  float roughness; /* GGX alpha = roughness^2 */
  float ior;
} WSurfaceMaterial;

/* Lights that are sampled. kind 0 sphere, 1 mesh (triangles of the scene, area weighted), 2 environment. A quad is a
 * mesh of two triangles. */
#define W_LIGHT_SPHERE 0
#define W_LIGHT_MESH 1
#define W_LIGHT_ENVIRONMENT 2
typedef struct WLight {
  w_float4 radiance; /* rgb; w = probability of choosing this light */
  w_float4 center;   /* sphere: centre xyz, radius w */
  w_int kind;
  w_uint first_triangle; /* mesh: range in the light triangle list */
  w_uint triangles;
  float area; /* m^2, of all triangles */
} WLight;

/* Sphere that rays meet (a light, or a body). */
typedef struct WSphere {
  w_float4 center; /* xyz, radius in w */
  w_int material;  /* surface material */
  w_int light;     /* or -1 */
  w_int pad0, pad1;
} WSphere;

/* Environment: equirectangular, width x height texels of rgb (float4), row 0 at the top (+up), direction by
   docs/lights.md; or a constant when width = 0. */
typedef struct WEnvironment {
  w_float4 radiance;    /* rgb when width = 0; w = 1 if the environment exists */
  w_float4 to_local[3]; /* rows of the world -> map rotation */
  w_int width, height;
  float average; /* mean of the sampling density's weight over the sphere */
  w_int light;   /* index of its WLight or -1 */
} WEnvironment;

/* kind 0 perspective (thin lens when aperture > 0), 1 orthographic. x right, y up, film plane [-1,1]*half size. */
typedef struct WCamera {
  w_float4 origin, right, up, forward;
  float half_width, half_height;     /* tangent of half the field of view, or half the film in metres (orthographic) */
  float aperture, focus;             /* lens radius and distance of the plane in focus, metres */
  w_int kind, width, height, filter; /* filter 0 box, 1 tent of 2 pixels */
} WCamera;

/* Key of a ray that passes through no ply (sampling/dimensions.clh). */
#define W_KEY_OPAQUE 0xffffffffu

/* Everything that changes between launches. */
typedef struct WFrame {
  w_uint paths; /* in this wave */
  w_uint seed;
  w_uint samples_before;  /* samples per pixel already done: sample = samples_before + local */
  w_uint samples_in_wave; /* per pixel */
  w_uint max_depth;     /* 0 = unlimited */
  w_int light_sampling; /* 0 MIS, 1 light sampling only, 2 BSDF sampling only */
  w_uint lights;
  w_uint spheres;
  w_uint roulette_depth; /* first depth at which Russian roulette may end a path */
  w_uint opaque_shadows; /* 1: plies stop shadow rays whole */
} WFrame;

/* Rare events, counted on the device: never hidden. */
#define W_EVENT_NAN 0        /* sample that is not finite */
#define W_EVENT_STACK_FULL 1 /* subtree left out, the traversal's stack was full */
#define W_EVENT_PATH_CAP 2   /* path at its length limit */
#define W_EVENT_ENERGY 3     /* scattering that would return more light than arrives */
#define W_EVENT_RAY 4        /* ray whose origin or direction is not finite, or whose direction is not unit: a miss */
#define W_EVENT_SPHERE 5     /* nearest hit on the sphere of a joint whose mitre does not fit, or of an open end */
#define W_EVENT_PARALLEL 6   /* ply segment that a ray ran along inside its radius: no entry through the side */
#define W_EVENT_COUNT 8

#ifndef __OPENCL_VERSION__
static_assert(sizeof(w_float4) == 16);
static_assert(sizeof(WAnchor) == 32);
static_assert(sizeof(WTileVertex) == 80);
static_assert(sizeof(WLatticeRun) == 64);
static_assert(sizeof(WGrid) == 48);
static_assert(sizeof(WPlyMaterial) == 128);
static_assert(sizeof(WFibreDetail) == 48);
static_assert(sizeof(WFibreMaterial) == 48);
static_assert(sizeof(WSurfaceMaterial) == 48);
static_assert(sizeof(WLight) == 48);
static_assert(sizeof(WSphere) == 32);
static_assert(sizeof(WEnvironment) == 80);
static_assert(sizeof(WCamera) == 96);
static_assert(sizeof(WFrame) == 40);
#endif
#endif
