#pragma once
#include "host/lattice_device.h"

namespace wale {

/// Lattice fabrics of a scene, numbered: vertices of the stored ones from first_vertex on, then ids of procedural ones.
struct LatticeFabrics {
  LatticeDevice device;
  std::vector<StoredRun> runs;    ///< that fill in the stored vertices
  std::vector<PlyPatch> patches;  ///< over them
  size_t stored_vertices = 0;
  ProceduralLeaves procedural;
  size_t segments = 0;        ///< of procedural leaves
  uint32_t tight_joints = 0;  ///< which made fabrics stored that were to be procedural
};

/// Ply vertices of a lattice fabric that is stored, ghosts included.
size_t lattice_vertices(const Fabric& fabric);

/// Numbers the fabrics and uploads their lattices. A procedural fabric with mitres that need a sphere (pack.cl) inside
/// a yarn becomes a stored one, of the same bits. `plies`: number of the first ply; set to that behind the last. Throws
/// a user error when ids run out.
LatticeFabrics place_lattices(const Device& device, std::vector<LatticeInput> inputs, dvec3 origin, Joints joints,
                              size_t first_vertex, size_t& plies);

}  // namespace wale
