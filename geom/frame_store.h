#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "geom/base_mesh.h"
#include "geom/byte_source.h"

namespace wale {

/// How a mesh file is read: read_mesh() of geom/base_mesh.h.
using MeshReader = std::function<BaseMesh(const std::filesystem::path&)>;

/// Meshes by number, as files hold them. Nothing of a mesh is read before it is asked for, nor kept.
class FrameStore {
 public:
  virtual ~FrameStore() = default;
  /// Numbers that there are, ascending.
  virtual const std::vector<long>& numbers() const = 0;
  /// What is read for a number, for messages.
  virtual std::string name(long number) const = 0;
  /// Throws a user error that names it where it is not there, or no mesh.
  virtual BaseMesh read(long number) const = 0;
  /// Hash of the bytes that it is read from.
  virtual uint64_t hash(long number) const = 0;
};

/// One file a mesh: "cloth_####.obj", where the signs stand for the number with at least so many digits. Throws a user
/// error when the signs are absent or in several places, or the folder holds no such file.
std::unique_ptr<FrameStore> numbered_files(const std::filesystem::path& pattern, MeshReader read);

/// A `.bin` file of frames as MADYPG (Sperl et al. 2021) writes it with bitsery: per frame vertices, triangles, UV and
/// UV triangles, where an empty one is that of the first frame; obstacles are skipped. Numbered from 0. Throws a user
/// error when the file is cut off or says what cannot be.
std::unique_ptr<FrameStore> binary_frames(ByteSource source);

/// A PC2 point cache, the vertices of a mesh at samples numbered from 0. Throws a user error when it is cut off, or is
/// of another number of vertices.
std::unique_ptr<FrameStore> point_cache(ByteSource source, BaseMesh base);
/// Frames per sample of a point cache, above 0.
double frames_per_sample(const ByteSource& source);

}  // namespace wale
