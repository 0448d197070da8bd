#include "host/fabric_device.h"

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <memory>
#include <utility>

#include "geom/error.h"

namespace wale {
namespace {

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

size_t cells_of(const Fabric& fabric) {
  size_t cells = fabric.cell_triangles.offset.empty() ? 0 : fabric.cell_triangles.offset.size() - 1;
  for (const UvGrid& grid : fabric.grids)
    cells = std::max(cells, size_t(grid.first_cell) + size_t(grid.size.x) * size_t(grid.size.y));
  for (const Patch& patch : fabric.patches) cells = std::max<size_t>(cells, patch.cell + 1);
  return cells;
}

dvec2 cell_corner(const UvGrid& grid, uint32_t local) {
  return grid.origin + grid.cell_size * dvec2(local % uint32_t(grid.size.x), local / uint32_t(grid.size.x));
}

// Bounds of the base triangles of every cell of one fabric, each clipped to its cell. Across a join a triangle may lie
// whole periods away from the cell that lists it.
void append_group_boxes(std::vector<Box>& boxes, const Fabric& fabric, dvec3 origin, size_t first_cell) {
  for (const UvGrid& grid : fabric.grids)
    for (uint32_t at = 0; at < uint32_t(grid.size.x) * uint32_t(grid.size.y); ++at) {
      const uint32_t cell = grid.first_cell + at;
      if (cell + 1 >= fabric.cell_triangles.offset.size()) continue;
      for (uint32_t i = fabric.cell_triangles.offset[cell]; i < fabric.cell_triangles.offset[cell + 1]; ++i)
        for (int sx = grid.wrap.x ? -1 : 0; sx <= (grid.wrap.x ? 1 : 0); ++sx)
          for (int sy = grid.wrap.y ? -1 : 0; sy <= (grid.wrap.y ? 1 : 0); ++sy) {
            const dvec2 lo = cell_corner(grid, at) + dvec2(sx * grid.wrap.x, sy * grid.wrap.y) * grid.cell_size;
            join(boxes[first_cell + cell],
                 clipped_triangle_box(fabric.mesh, fabric.cell_triangles.item[i], lo, lo + grid.cell_size, origin));
          }
    }
}

// Base mesh, grids and lists of the cell stages.
struct CellLists {
  std::vector<uint32_t> triangle_offsets{0}, triangles, segment_offsets{0}, segments, grid_of_cell;
  std::vector<WGrid> grids;
  std::vector<float> uv;
};

void append(CellLists& out, const Fabric& fabric, size_t cells, uint32_t first_cell, uint32_t first_triangle,
            const std::vector<uint32_t>& code_of_vertex, uint32_t first_vertex) {
  const uint32_t first_grid = uint32_t(out.grids.size());
  out.grid_of_cell.resize(first_cell + cells, 0);
  for (const UvGrid& g : fabric.grids) {
    // UVs are stored relative to their grid's corner: far from 0 a float would lose the cell.
    out.grids.push_back({g.first_cell + first_cell, g.size.x, g.size.y, g.wrap.x, 0, 0, float(1 / g.cell_size.x),
                         float(1 / g.cell_size.y), g.wrap.y, 0, 0, 0});
    std::fill_n(out.grid_of_cell.begin() + first_cell + g.first_cell, size_t(g.size.x) * size_t(g.size.y),
                uint32_t(out.grids.size() - 1));
  }
  for (size_t t = 0; t < fabric.mesh.triangle.size(); ++t) {
    uint32_t chart = t < fabric.chart_of_triangle.size() ? fabric.chart_of_triangle[t] : 0;
    if (chart >= fabric.grids.size()) chart = 0;
    const dvec2 corner = fabric.grids.empty() ? dvec2(0) : fabric.grids[chart].origin;
    for (const dvec2& uv : fabric.mesh.uv[t]) {
      out.uv.push_back(float(uv.x - corner.x));
      out.uv.push_back(float(uv.y - corner.y));
    }
    out.uv.push_back(std::bit_cast<float>(first_grid + chart));
  }
  for (size_t cell = 0; cell < cells; ++cell) {
    if (cell + 1 < fabric.cell_triangles.offset.size())
      for (uint32_t i = fabric.cell_triangles.offset[cell]; i < fabric.cell_triangles.offset[cell + 1]; ++i)
        out.triangles.push_back(fabric.cell_triangles.item[i] + first_triangle);
    out.triangle_offsets.push_back(uint32_t(out.triangles.size()));
    const size_t start = out.segments.size();
    if (cell + 1 < fabric.cell_segments.offset.size())
      for (uint32_t i = fabric.cell_segments.offset[cell]; i < fabric.cell_segments.offset[cell + 1]; ++i) {
        const uint32_t code = code_of_vertex[first_vertex + fabric.cell_segments.item[i]];
        if (code != W_NONE) out.segments.push_back(code);
      }
    std::sort(out.segments.begin() + start, out.segments.end());  // leaf by leaf
    out.segment_offsets.push_back(uint32_t(out.segments.size()));
  }
}

}  // namespace

void update_fabrics(const Device& device, FabricDevice& fabrics, std::span<const float> positions,
                    std::span<const float> normals) {
  if (!fabrics.warp) bug("fabrics: not uploaded to be updatable");
  const double start = now();
  fabrics.warp->move(device, positions, normals);
  device.queue().finish();
  fabrics.move_seconds = now() - start;
  refit(device, fabrics.tree);
  fabrics.refit_seconds = now() - start - fabrics.move_seconds;
}

Box clipped_triangle_box(const BaseMesh& mesh, uint32_t triangle, dvec2 cell_lo, dvec2 cell_hi, dvec3 origin) {
  struct Corner {
    dvec2 uv;
    dvec3 position;
  };
  std::vector<Corner> polygon, clipped;
  for (int k = 0; k < 3; ++k)
    polygon.push_back({mesh.uv[triangle][k], mesh.position[mesh.triangle[triangle][k]] - origin});
  // Sutherland and Hodgman, one side of the cell after the other.
  for (int side = 0; side < 4 && !polygon.empty(); ++side) {
    const int axis = side / 2;
    const auto inside = [&](const Corner& c) {
      return side % 2 == 0 ? c.uv[axis] - cell_lo[axis] : cell_hi[axis] - c.uv[axis];
    };
    clipped.clear();
    for (size_t i = 0; i < polygon.size(); ++i) {
      const Corner &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      const double da = inside(a), db = inside(b);
      if (da >= 0) clipped.push_back(a);
      if ((da >= 0) != (db >= 0)) {
        const double t = da / (da - db);
        clipped.push_back({a.uv + t * (b.uv - a.uv), a.position + t * (b.position - a.position)});
      }
    }
    polygon.swap(clipped);
  }
  Box box;
  for (const Corner& c : polygon)
    for (int k = 0; k < 3; ++k) {
      box.lo[k] = std::min(box.lo[k], std::nextafter(float(c.position[k]), -INFINITY));
      box.hi[k] = std::max(box.hi[k], std::nextafter(float(c.position[k]), INFINITY));
    }
  return box;
}

FabricDevice upload_fabrics(const Device& device, std::span<const FabricInput> inputs, dvec3 origin, LocalStage stage,
                            bool updatable, LeafForm form) {
  FabricDevice out;
  const double start = now();
  std::vector<PlyPatch> patches;
  std::vector<LatticeInput> lattices;
  size_t curves = 0;
  uint32_t first_vertex = 0, first_triangle = 0;
  for (uint32_t f = 0; f < inputs.size(); ++f) {
    const Fabric& fabric = *inputs[f].fabric;
    out.first_vertex.push_back(first_vertex);
    out.first_cell.push_back(uint32_t(out.cell_count));
    out.first_triangle.push_back(first_triangle);
    first_vertex += uint32_t(fabric.anchors.size());
    if (fabric.lattice.empty()) first_triangle += uint32_t(fabric.mesh.triangle.size());
    std::vector<uint32_t> first_curve;  // per run, over all fabrics
    for (const PlyRun& run : fabric.runs) {
      first_curve.push_back(uint32_t(curves));
      curves += run.plies;
    }
    for (const Patch& p : fabric.patches) {
      const PlyRun& run = fabric.runs[p.run];
      const bool fibre = run.kind == PlyRun::Kind::fibre;
      patches.push_back({out.first_vertex[f] + run.first_vertex, run.count, p.first, p.intervals, run.plies,
                         out.first_cell[f] + p.cell, f,
                         fibre ? W_MATERIAL_FIBRE | inputs[f].fibre_material : inputs[f].material, first_curve[p.run],
                         run.radius, fibre ? -1.0f : inputs[f].tau, run.ghost_ends});
      out.segment_count += size_t(p.intervals) * run.plies;
    }
    out.cell_count += cells_of(fabric);
    if (!fabric.lattice.empty()) lattices.push_back({&fabric, f, inputs[f].material, inputs[f].tau});
  }
  if (stage != LocalStage::exact)
    for (const FabricInput& input : inputs)
      if (!input.fabric->patches.empty() && input.fabric->cell_segments.offset.empty())
        bug("fabric '{}': knitted without the lists that its local stage reads", input.fabric->name);
  if (!lattices.empty() && stage != LocalStage::exact)
    user_error(
        "fabric '{}': it is held as a lattice, which has no UV cells; use integrator.local_stage \"exact\", or "
        "storage \"stored\" and no lattice",
        lattices[0].fabric->name);
  if (!lattices.empty() && updatable) bug("fabric '{}': a lattice cannot follow its mesh", lattices[0].fabric->name);
  LatticeFabrics placed;
  if (!lattices.empty()) placed = place_lattices(device, lattices, origin, form.joints, first_vertex, curves);
  for (const PlyPatch& p : placed.patches) out.segment_count += size_t(p.intervals) * p.plies;
  out.segment_count += placed.segments;
  patches.insert(patches.end(), placed.patches.begin(), placed.patches.end());
  out.patch_count = patches.size() + placed.procedural.number.size();
  out.vertex_count = first_vertex + placed.stored_vertices;
  out.triangle_count = first_triangle;
  out.tight_joints = placed.tight_joints;

  auto warp = std::make_unique<FabricWarp>(device, inputs, origin, placed.stored_vertices);
  out.frames = warp->frames();
  const Buffer<float> points = warp->points();
  placed.device.warp(device, placed.runs, points, out.frames);
  out.warp_seconds = now() - start;
  if (stage != LocalStage::exact) {
    out.base_positions = warp->base_positions();
    out.base_indices = warp->base_triangles();
  }
  if (updatable)
    out.warp = std::move(warp);
  else
    warp.reset();

  std::vector<Box> group_boxes;
  if (stage != LocalStage::exact) {
    group_boxes.resize(out.cell_count);
    for (size_t f = 0; f < inputs.size(); ++f)
      append_group_boxes(group_boxes, *inputs[f].fabric, origin, out.first_cell[f]);
  }
  out.tree = build_ply_tree(device, patches, points, group_boxes, updatable, std::move(placed.procedural), form);
  out.lattice = std::move(placed.device);
  out.pack_seconds = out.tree.pack_seconds;
  out.build_seconds = out.tree.build_seconds;
  out.node_count = out.tree.node_count;
  out.bytes = out.frames.bytes() + out.tree.leaves.bytes() + out.tree.tree_bytes() + out.lattice.bytes();
  if (updatable) out.bytes += points.bytes() + out.warp->bytes() + out.tree.refit->bytes();
  if (stage == LocalStage::exact) return out;

  std::vector<uint32_t> code_of_vertex(out.vertex_count, W_NONE);
  for (size_t i = 0; i < patches.size(); ++i)
    for (uint32_t k = 0; k < patches[i].intervals; ++k)
      for (uint32_t p = 0; p < patches[i].plies; ++p)
        code_of_vertex[patches[i].first_vertex + p * patches[i].count + patches[i].first + k] =
            out.tree.hit_code(i, patches[i].plies, k, p);
  CellLists lists;
  for (size_t f = 0; f < inputs.size(); ++f) {
    const size_t last = f + 1 < inputs.size() ? out.first_cell[f + 1] : out.cell_count;
    append(lists, *inputs[f].fabric, last - out.first_cell[f], out.first_cell[f], out.first_triangle[f], code_of_vertex,
           out.first_vertex[f]);
  }
  out.base_uv = Buffer<float>(device, lists.uv);
  out.cell_triangle_offsets = Buffer<uint32_t>(device, lists.triangle_offsets);
  out.cell_triangles = Buffer<uint32_t>(device, lists.triangles);
  out.cell_segment_offsets = Buffer<uint32_t>(device, lists.segment_offsets);
  out.cell_segments = Buffer<uint32_t>(device, lists.segments);
  out.grid_of_cell = Buffer<uint32_t>(device, lists.grid_of_cell);
  out.grids = Buffer<WGrid>(device, lists.grids);
  for (size_t bytes : {out.base_positions.bytes(), out.base_indices.bytes(), out.base_uv.bytes(),
                       out.cell_triangle_offsets.bytes(), out.cell_triangles.bytes(), out.cell_segment_offsets.bytes(),
                       out.cell_segments.bytes(), out.grid_of_cell.bytes(), out.grids.bytes()})
    out.bytes += bytes;
  return out;
}

}  // namespace wale
