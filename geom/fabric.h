#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "geom/base_mesh.h"
#include "geom/charts.h"
#include "geom/flat_knit.h"

namespace wale {

/// How large the tile is on the cloth: one of the scene's three keys.
struct FabricScale {
  enum class Kind { repeats, gauge, uv_metres } kind = Kind::repeats;
  dvec2 repeats{1, 1};  ///< tiles across u and v in [0,1]
  dvec2 gauge{0, 0};    ///< wales and courses per metre; a zero follows from the tile's aspect
};

struct FabricSpec {
  std::string name;
  FabricScale scale;
  int plies = 3;
  double twist_pitch = 8;    ///< yarn radii of cloth yarn per turn of the plies; negative = left-handed; 0 = no twist
  double thickness = 1;      ///< factor on the yarn radius that the tile implies
  double ply_radius = 0;     ///< metres in the cloth; 0 = as many touching circles as fill the yarn
  double height_offset = 0;  ///< metres along the base normal
  double tolerance = 0.05;   ///< ply radii
  double patches_per_cell = 12;  ///< wanted size of a UV cell
  bool places = false;           ///< fill Fabric::place
};

/// One yarn, cut to its chart: `plies` polylines of `count` vertices each, ply p at first_vertex + p*count.
struct PlyRun {
  uint32_t first_vertex = 0, count = 0;
  uint32_t yarn = 0;  ///< full yarn that it was cut from
  uint32_t chart = 0;
  bool ghost_ends = false;  ///< closed yarn: first and last segment are neighbours only, not traced, no caps
};

/// Vertex of the flat knit tied to the base mesh: what kernels/warp.cl reads.
struct Anchor {
  uint32_t triangle = 0;
  float b1 = 0, b2 = 0;
  float height = 0;              ///< metres along the normal
  float nx = 0, ny = 0, nz = 0;  ///< frame normal in the flat knit
  float length = 0;              ///< rest length along the full ply, metres
};

/// Where a sample of a run lies on its strand, and in which stitch: what colours follow. One strand is knitted run
/// after run, flat pieces to and fro, so that `along` goes on from run to run.
struct StrandPlace {
  float along = 0;     ///< metres of yarn
  ivec2 stitch{0, 0};  ///< column and row, canonical where a chart is joined to itself
  float u = 0, v = 0;  ///< base UV of the stitch's middle
};

/// A run of `intervals` consecutive segments of all plies of one yarn: the leaf of the tree.
struct Patch {
  uint32_t run = 0;
  uint32_t first = 0;      ///< first segment, counted inside the run
  uint32_t intervals = 0;  ///< at most W_LEAF_LANES / plies
  uint32_t cell = 0;       ///< owner
};

/// Uniform grid over the UVs of one chart, aligned with the tile; cells are numbered first_cell + x + nx*y.
struct UvGrid {
  uint32_t first_cell = 0;
  ivec2 size{0, 0};
  dvec2 origin{0, 0};     ///< UV of the corner of cell (0,0)
  dvec2 cell_size{1, 1};  ///< UV
  ivec2 wrap{0, 0};       ///< columns / rows identified modulo this (joined charts); 0 = none
};

/// Compressed rows: items of row i are item[offset[i]] .. item[offset[i+1]).
struct Csr {
  std::vector<uint32_t> offset, item;
};

/// A knitted fabric, tied to its base mesh, ready for the device. Numbers of vertices, cells and triangles are local to
/// the fabric; the host concatenates.
struct Fabric {
  std::string name;
  int plies = 0;
  double ply_radius = 0, yarn_radius = 0;  ///< metres in the cloth
  BaseMesh mesh;
  std::vector<Chart> charts;
  std::vector<dvec2> uv_per_metre;  ///< per chart: UV = uv_per_metre * (x, y), (x, y) in the flat knit
  std::vector<PlyRun> runs;
  std::vector<Anchor> anchors;     ///< per vertex
  std::vector<StrandPlace> place;  ///< where FabricSpec::places: sample k of a run at first_vertex / plies + k
  std::vector<uint32_t> chart_of_triangle;
  std::vector<Patch> patches;  ///< sorted by cell
  std::vector<UvGrid> grids;   ///< per chart
  Csr cell_triangles;          ///< triangles that cover the cell (UV overlap)
  Csr cell_segments;           ///< segments that touch the cell: vertex ids of their starts
  struct Report {
    size_t full_yarns = 0, runs = 0, plies = 0, segments = 0, vertices = 0;
    size_t samples_outside = 0;       ///< yarn samples beyond the half-stitch margin, not traced
    size_t samples_extrapolated = 0;  ///< in the margin
    size_t jumps_cut = 0;             ///< places where a yarn was cut because its chart folds back beside itself in UV
    double worst_partner_distance = 0;   ///< metres in the pattern
    std::vector<ivec2> snapped_repeats;  ///< per joined chart, whole tiles across the join
    dvec2 tile_metres{0, 0};             ///< size of one tile in the cloth
    dvec2 stitch_metres{0, 0};
    bool mirrored = false;
  } report;
};

/// Ply segments that the fabric would have, to a few per cent; computed before anything is allocated.
size_t estimate_segments(const BaseMesh& mesh, const Pattern& pattern, const FabricSpec& spec);

/// Knits the pattern over the mesh: charts, scale, tiling and stitching, plies, cutting at borders (half a stitch past
/// them), anchors, patches, UV grid with CSR lists. Throws a user error when the tile is larger than the cloth, the
/// twist, radius or period is not usable, or nothing lies on the cloth.
Fabric knit_fabric(BaseMesh mesh, const Pattern& pattern, const FabricSpec& spec);

}  // namespace wale
