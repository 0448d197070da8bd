#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "geom/wide_tree.h"
#include "host/device.h"
#include "host/leaf_buffers.h"
#include "host/leaf_form.h"
#include "host/leaf_steps.h"
#include "host/ply_refit.h"
#include "host/quantised_tree.h"

namespace wale {

/// A patch of plies, in numbers of the device's vertices; see W_LEAF_* in kernels/shared/wale_types.h.
struct PlyPatch {
  uint32_t first_vertex = 0;  ///< of the run's ply 0
  uint32_t count = 0;         ///< vertices per ply of the run
  uint32_t first = 0;         ///< first segment, counted inside the run
  uint32_t intervals = 0;
  uint32_t plies = 1;
  uint32_t cell = 0, fabric = 0;
  uint32_t material = 0;   ///< of plies, or W_MATERIAL_FIBRE | of fibres
  uint32_t first_ply = 0;  ///< number of the run's ply 0, over all fabrics
  float radius = 0;        ///< metres
  float tau = 0;           ///< optical radius; -1 or less = opaque
  bool ghost_ends = false;
};

/// Procedural leaves: their numbers (W_LEAF_PROCEDURAL included) and boxes.
struct ProceduralLeaves {
  std::vector<uint32_t> number;
  std::vector<Box> box;
};

/// Leaves and tree over patches, on the device.
struct PlyTree {
  LeafBuffers leaves;
  LeafForm form;
  Buffer<uint32_t> nodes;   ///< empty where they are quantised and not refitted
  QuantisedTree quantised;  ///< for devices that traverse by Traversal::simt
  size_t node_count = 0;
  Buffer<uint32_t> node_cell;         ///< for the cell stages only: see WideTree
  std::vector<uint32_t> leaf_offset;  ///< per patch, in 16-byte units; then the numbers of procedural leaves
  uint32_t root = 0xffffffffu;        ///< W_NONE when there is no patch
  Box bounds;
  std::unique_ptr<PlyRefit> refit;  ///< of updatable trees
  double pack_seconds = 0, build_seconds = 0;

  /// Bytes of nodes, and boxes of leaves, on the device.
  size_t tree_bytes() const { return nodes.bytes() + node_cell.bytes() + quantised.bytes(); }
  /// What rays go down by.
  const Buffer<uint32_t>& ray_nodes() const { return quantised.bytes() ? quantised.nodes() : nodes; }
  /// Hit code of segment k (inside the patch) of ply p.
  uint32_t hit_code(size_t patch, uint32_t plies, uint32_t k, uint32_t p) const {
    return leaf_offset[patch] << 4 | (k * plies + p);
  }
};

/// Metres from the scene's origin. The kernels multiply three lengths (kernels/geometry/ply_segment.clh), which a float
/// holds up to 7e12.
constexpr float kLargestCoordinate = 1e12f;

/// Packs leaves on the device and builds the tree on the host. `positions`: x, y, z a vertex, metres; not needed
/// afterwards. `procedural` leaves join the tree without being packed; they have no cells and cannot be refitted.
/// group_box: see build_wide_tree; when given, each UV cell
/// gets a node of its own (patches of one cell must follow one another in ascending order of cells), which the cell
/// stages need. Without it the tree is free of cells: a fifth smaller and faster (bench/results/embree.md).
/// `updatable`: keep what refit() needs, `positions` too.
/// Throws a device error when a leaf buffer would not fit, and a user error when a ply reaches farther out than
/// kLargestCoordinate, or has a vertex or radius that is no number.
PlyTree build_ply_tree(const Device& device, std::span<const PlyPatch> patches, const Buffer<float>& positions,
                       std::span<const Box> group_box = {}, bool updatable = false, ProceduralLeaves procedural = {},
                       LeafForm form = {});

/// Lets an updatable tree, free of cells, follow what the buffer of positions that it was built from holds now; nothing
/// is allocated. Waits for the device. Throws a user error when a ply reaches farther out than kLargestCoordinate.
void refit(const Device& device, PlyTree& tree);

}  // namespace wale
