#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "geom/fabric.h"
#include "host/device.h"
#include "shared/wale_types.h"

namespace wale {

/// A fabric and what its plies are made of on the device.
struct FabricInput {
  const Fabric* fabric = nullptr;
  uint32_t material = 0;        ///< ply material
  float tau = 0;                ///< effective optical radius of its plies; -1 or less = opaque
  uint32_t fibre_material = 0;  ///< of its explicit fibres, which are opaque
};

/// Vertices of base meshes, one fabric after the other, without those of lattices: x, y, z each, metres from the origin.
struct MeshVertices {
  std::vector<float> positions, normals;
};
MeshVertices mesh_vertices(std::span<const FabricInput> inputs, dvec3 origin);

/// The flat knits of a scene's fabrics carried on to their base meshes by the device (kernels/warp.cl). Vertices, mesh
/// vertices and triangles are numbered one fabric after the other. Nothing in it is needed once the tree is built,
/// unless the base meshes move.
class FabricWarp {
 public:
  /// Uploads and warps. `origin` is subtracted from base positions in double. Fabrics that have a lattice are left out;
  /// `more`: vertices of theirs to leave room for behind the others'. Throws device errors only.
  FabricWarp(const Device& device, std::span<const FabricInput> inputs, dvec3 origin, size_t more = 0);

  /// Carries the fabrics on to moved base meshes: three floats a mesh vertex, metres from the origin, and unit normals.
  /// Returns before the device is done; allocates nothing. Throws a user error where a number is not finite.
  void move(const Device& device, std::span<const float> positions, std::span<const float> normals);

  const Buffer<float>& points() const { return points_; }                ///< x, y, z a vertex, metres from the origin
  const Buffer<float>& frames() const { return frames_; }                ///< W_FRAME_WORDS a vertex
  const Buffer<float>& base_positions() const { return positions_; }     ///< x, y, z a mesh vertex
  const Buffer<uint32_t>& base_triangles() const { return triangles_; }  ///< three mesh vertices each
  size_t vertices() const { return count_; }
  /// That it holds on the device beside points and frames.
  size_t bytes() const;

 private:
  void run(const Device& device);

  uint32_t count_ = 0;
  Buffer<WAnchor> anchors_;
  Buffer<float> positions_, normals_, cloth_, points_, frames_;
  Buffer<uint32_t> triangles_;
  Buffer<uint8_t> flags_;
  cl::Kernel warp_points_, warp_normals_;
};

}  // namespace wale
