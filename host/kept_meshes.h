#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "geom/base_mesh.h"
#include "host/file_stamp.h"
#include "host/scene.h"

namespace wale {

struct Loaders;

/// Meshes as a scene names them, before their transforms: of props and lights. An edit of something else finds them
/// there, as long as their files are as they were.
class KeptMeshes {
 public:
  /// As load_mesh(). Of an earlier version where that has it.
  std::shared_ptr<const BaseMesh> load(const MeshSource& source, const Loaders& loaders, const KeptMeshes* earlier,
                                       std::vector<std::string>& notes);

 private:
  struct Kept {
    MeshSource source;
    std::vector<FileStamp> files;
    std::shared_ptr<const BaseMesh> mesh;
    std::vector<std::string> notes;
  };
  std::vector<std::shared_ptr<const Kept>> kept_;
};

}  // namespace wale
