#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "host/fabric_warp.h"
#include "host/lattice_fabrics.h"
#include "host/local_stage.h"
#include "host/ply_tree.h"
#include "shared/wale_types.h"

namespace wale {

/// All fabrics of a scene on the device, warped, packed and with their tree. Vertices, cells, triangles and grids of
/// the fabrics are numbered one fabric after the other; fabric f's vertices start at first_vertex[f].
struct FabricDevice {
  Buffer<float> frames;  ///< W_FRAME_WORDS a vertex; where it lies is in the leaves
  PlyTree tree;
  LatticeDevice lattice;             ///< of fabrics that have one
  uint32_t tight_joints = 0;         ///< that made procedural fabrics stored, see place_lattices
  std::unique_ptr<FabricWarp> warp;  ///< of updatable fabrics
  std::vector<uint32_t> first_vertex, first_cell, first_triangle;

  // Filled for the cell stages only; layouts as in kernels/geometry/scene.clh.
  Buffer<float> base_positions, base_uv;
  Buffer<uint32_t> base_indices;
  Buffer<uint32_t> cell_triangle_offsets, cell_triangles, cell_segment_offsets, cell_segments, grid_of_cell;
  Buffer<WGrid> grids;

  size_t vertex_count = 0, segment_count = 0, patch_count = 0, cell_count = 0, triangle_count = 0, node_count = 0;
  size_t bytes = 0;  ///< that stay on the device
  double warp_seconds = 0, pack_seconds = 0, build_seconds = 0;
};

/// Warps, packs and uploads. `origin` is subtracted from base positions in double. `updatable`: keep what
/// update_fabrics() needs, about 47 bytes a segment more; for the exact stage only. Throws device errors only.
FabricDevice upload_fabrics(const Device& device, std::span<const FabricInput> inputs, dvec3 origin,
                            LocalStage stage = LocalStage::exact, bool updatable = false, LeafForm form = {});

/// Carries updatable fabrics on to moved base meshes, on the device: three floats a mesh vertex, all fabrics one after
/// the other, metres from the origin that upload_fabrics() was given, and unit normals. Nothing is allocated. Throws a
/// user error where a number is not finite or a ply ends up beyond kLargestCoordinate.
void update_fabrics(const Device& device, FabricDevice& fabrics, std::span<const float> positions,
                    std::span<const float> normals);

/// Bounds of the part of a cell that a triangle covers (host side of the cell stages; exposed for tests): the triangle
/// is clipped in UV to the cell, so that a large triangle under many cells gives each its own part. Empty box when they
/// do not meet.
Box clipped_triangle_box(const BaseMesh& mesh, uint32_t triangle, dvec2 cell_lo, dvec2 cell_hi, dvec3 origin);

}  // namespace wale
