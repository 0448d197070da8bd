/* Stored vertices of a cloth that is held as a lattice: the same points, bit by bit, as its procedural leaves have. */
#include "geometry/lattice.clh"
#include "geometry/vertex_frame.clh"

/* One yarn of the tile, all over the cloth. Line `l` of tiles (a row or a column) carries run l: `plies` polylines of
   `count` vertices. */
typedef struct Place {
  __global const WTileVertex* tile;
  __global const float* corner;
  uint vertex, along, line, ply; /* along: tiles from the first, also past the ends of a closed yarn */
  int at;                        /* inside the polyline */
} Place;

static Place place_of(uint i, __global const float* lattice, __global const uint* tiles, WLatticeRun run) {
  Place place;
  place.at = (int)(i % run.count);
  place.ply = i / run.count % run.plies;
  place.line = i / run.count / run.plies;
  place.vertex = run.first_vertex + i;
  const int samples = (int)run.samples, from = place.at - (int)run.ghosts;
  int along = from >= 0 ? from / samples : -1;
  int k = from - along * samples;
  if (along == (int)run.tiles && !run.ghosts) along -= 1, k = samples; /* the end of an open yarn */
  place.along = (uint)along;
  place.tile = (__global const WTileVertex*)(tiles + run.table) + (place.ply * run.stride + (uint)k);
  const uint around = (uint)((along + (int)run.tiles) % (int)run.tiles);
  const uint column = run.axis ? place.line : around, row = run.axis ? around : place.line;
  place.corner = lattice + (size_t)(run.corner + run.cells * (column + row * run.pitch)) * W_LATTICE_WORDS;
  return place;
}

/* Writes where every vertex lies: x, y, z. */
__kernel void lattice_points(__global const float* lattice, __global const uint* tiles, WLatticeRun run,
                             __global float* points, __global float4* frames, uint items) {
  const uint i = get_global_id(0);
  if (i >= items) return;
  const Place place = place_of(i, lattice, tiles, run);
  vstore3(w_tile_point(place.tile, place.corner), place.vertex, points);
}

/* Frames and lengths; needs every vertex's position. */
__kernel void lattice_normals(__global const float* lattice, __global const uint* tiles, WLatticeRun run,
                              __global const float* points, __global float4* frames, uint items) {
  const uint i = get_global_id(0);
  if (i >= items) return;
  const Place place = place_of(i, lattice, tiles, run);
  const size_t here = place.vertex;
  const size_t before = place.at == 0 ? here : here - 1, after = place.at + 1 == (int)run.count ? here : here + 1;
  const float3 normal = w_one_vertex_frame(w_tile_normal(place.tile, place.corner), w_load3(before, points),
                                     w_load3(here, points), w_load3(after, points));
  frames[here] = (float4)(
      normal, w_tile_length(place.tile, place.along, run.first_ply + place.line * run.plies, place.ply, run.radius));
}
