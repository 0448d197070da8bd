#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "geom/base_mesh.h"
#include "geom/charts.h"
#include "geom/fibre_section.h"
#include "geom/flat_knit.h"
#include "geom/flyaways.h"
#include "geom/lattice.h"

namespace wale {

/// How large the tile is on the cloth: one of the scene's three keys.
struct FabricScale {
  enum class Kind { repeats, gauge, uv_metres } kind = Kind::repeats;
  dvec2 repeats{1, 1};  ///< tiles across u and v in [0,1]
  dvec2 gauge{0, 0};    ///< wales and courses per metre; a zero follows from the tile's aspect

  bool operator==(const FabricScale&) const = default;
};

/// How much of a ply is shown: nothing but the tube; as KNIT21, or maps of the fibres on it; the fibres themselves.
/// The first three share one geometry and differ in shading alone.
enum class Detail { none, paper, maps, fibres };

/// What a yarn does where its cloth is stretched: its tile is scaled, or takes the shape that its strain table gives.
enum class LoopStrain { affine, relaxed };

/// How the points of a fabric are held: kept, or warped anew from a lattice wherever a ray needs them.
enum class Storage { automatic, stored, procedural };

struct FabricSpec {
  std::string name;
  FabricScale scale;
  int plies = 3;
  double twist_pitch = 8;    ///< yarn radii of cloth yarn per turn of the plies; negative = left-handed; 0 = no twist
  double thickness = 1;      ///< factor on the yarn radius that the tile implies
  double ply_radius = 0;     ///< metres in the cloth; 0 = as many touching circles as fill the yarn
  double height_offset = 0;  ///< metres along the base normal
  double tolerance = 0.05;   ///< ply radii; explicit fibres keep to kFibreTolerance instead where that is finer
  double patches_per_cell = 12;  ///< wanted size of a UV cell
  Detail detail = Detail::maps;
  FibreRecipe fibres;  ///< what its plies are made of
  FlyawaySpec flyaways;
  bool places = false;     ///< fill Fabric::place
  bool cell_lists = true;  ///< fill Fabric::cell_triangles and cell_segments
  LoopStrain strain = LoopStrain::affine;
  Storage storage = Storage::automatic;
  int lattice = 0;  ///< cells along a tile's side of a lattice that takes the mesh's place in the warp; 0 = none

  bool operator==(const FabricSpec&) const = default;
};

/// Largest distance of an explicit fibre's polyline from its curve, fibre radii.
constexpr double kFibreTolerance = 0.25;

/// Neighbouring fibres of one ply that share a leaf.
constexpr uint32_t kFibreGroup = 4;

/// Curves of one yarn, cut to its chart: `plies` polylines of `count` vertices each, curve p at first_vertex + p*count.
/// All plies of the yarn, a few neighbouring fibres of one of them, or one flyaway.
struct PlyRun {
  enum class Kind : uint32_t { ply, fibre };
  uint32_t first_vertex = 0, count = 0;
  uint32_t plies = 1;  ///< curves, 1 to 8
  Kind kind = Kind::ply;
  float radius = 0;   ///< of the curves, metres
  uint32_t yarn = 0;   ///< full yarn that it was cut from
  uint32_t color = 0;  ///< PatternCurve::yarn of it
  uint32_t chart = 0;
  uint32_t ply = 0;          ///< kind fibre: of which ply of the yarn
  uint32_t first_place = 0;  ///< its first sample's Fabric::place, where they are filled
  bool one_place = false;    ///< a flyaway: all its vertices share that of its root
  bool ghost_ends = false;   ///< closed yarn: first and last segment are neighbours only, not traced, no caps
};

/// Vertex of the flat knit tied to the base mesh: what kernels/warp.cl reads.
struct Anchor {
  uint32_t triangle = 0;
  float b1 = 0, b2 = 0;
  float height = 0;              ///< metres along the normal
  float nx = 0, ny = 0, nz = 0;  ///< frame normal in the flat knit
  float length = 0;              ///< rest length along the full ply, metres, wrapped: see geom/stored_length.h
};

/// Where a sample of a run lies on its strand, and in which stitch: what colours follow. One strand is knitted run
/// after run, flat pieces to and fro, so that `along` goes on from run to run.
struct StrandPlace {
  float along = 0;     ///< metres of yarn
  ivec2 stitch{0, 0};  ///< column and row, canonical where a chart is joined to itself
  float u = 0, v = 0;  ///< base UV of the stitch's middle
};

/// `intervals` consecutive segments of all curves of one run: the leaf of the tree.
struct Patch {
  uint32_t run = 0;
  uint32_t first = 0;      ///< first segment, counted inside the run
  uint32_t intervals = 0;  ///< at most W_LEAF_LANES / the run's curves
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

/// The strains that a fabric's loops follow.
struct StrainReport {
  size_t samples = 0;  ///< of yarns on the cloth
  size_t clamped = 0;  ///< of them where the cloth is strained beyond the tile's table, whose border was taken
  dvec2 least{0, 0}, most{0, 0};  ///< along course and wale
  void add(const StrainReport& other);
};

/// A knitted fabric, tied to its base mesh, ready for the device. Numbers of vertices, cells and triangles are local to
/// the fabric; the host concatenates.
struct Fabric {
  std::string name;
  int plies = 0;
  double ply_radius = 0, yarn_radius = 0;  ///< metres in the cloth
  double fibre_radius = 0;                 ///< of explicit fibres, metres; 0 where there are none
  double flyaway_radius = 0;               ///< metres
  BaseMesh mesh;
  std::vector<Chart> charts;
  std::vector<dvec2> uv_per_metre;  ///< per chart: UV = uv_per_metre * (x, y), (x, y) in the flat knit
  std::vector<PlyRun> runs;
  std::vector<Anchor> anchors;     ///< per vertex
  std::vector<StrandPlace> place;  ///< where FabricSpec::places: sample k of a run at first_vertex / plies + k
  std::vector<uint32_t> chart_of_triangle;
  std::vector<Patch> patches;         ///< sorted by cell
  std::vector<UvGrid> grids;          ///< per chart
  Csr cell_triangles;                 ///< where FabricSpec::cell_lists: triangles that cover the cell (UV overlap)
  Csr cell_segments;                  ///< and segments that touch it: vertex ids of their starts
  std::vector<LatticeChart> lattice;  ///< of a regular cloth, in place of runs, anchors, patches and cells
  bool procedural = false;            ///< it is to stay a lattice
  double fibre_twist = 0;             ///< of a lattice: FibreRecipe::twist
  struct Report {
    size_t full_yarns = 0, runs = 0, segments = 0, vertices = 0;
    size_t plies = 0, fibres = 0;     ///< curves of each kind
    size_t flyaways = 0;              ///< fibres that stand off a ply
    size_t samples_outside = 0;       ///< yarn samples beyond the half-stitch margin, not traced
    size_t samples_extrapolated = 0;  ///< in the margin
    size_t jumps_cut = 0;             ///< places where a yarn was cut because its chart folds back beside itself in UV
    StrainReport strain;              ///< LoopStrain::relaxed: otherwise empty
    double worst_partner_distance = 0;   ///< metres in the pattern
    std::vector<ivec2> snapped_repeats;  ///< per joined chart, whole tiles across the join
    std::vector<dvec2> tile_phase;       ///< per knitted chart, where in a tile its UV begins, [0, 1)
    dvec2 tile_metres{0, 0};             ///< size of one tile in the cloth
    dvec2 stitch_metres{0, 0};
    bool mirrored = false;
  } report;
};

/// Segments that the fabric would have, of plies or of explicit fibres, to a few per cent; computed before anything is
/// allocated.
size_t estimate_segments(const BaseMesh& mesh, const Pattern& pattern, const FabricSpec& spec);

/// Knits the pattern over the mesh: charts, scale, tiling and stitching, plies, cutting at borders (half a stitch past
/// them), anchors, patches, UV grid with CSR lists. Throws a user error when the tile is larger than the cloth, the
/// twist, radius or period is not usable, or nothing lies on the cloth. The same on any number of threads (0: as many
/// as the machine has cores).
Fabric knit_fabric(BaseMesh mesh, const Pattern& pattern, const FabricSpec& spec, unsigned threads = 0);

}  // namespace wale
