#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "geom/base_mesh.h"
#include "host/scene.h"

namespace wale {

struct Loaders;

/// Which file or folder a name leads to, when it was changed last, and how long it is.
struct FileStamp {
  std::filesystem::path file;
  std::filesystem::file_time_type changed{};
  uintmax_t bytes = 0, number = 0;
  bool settled = false;  ///< it was not young then: a later change has another time
  bool operator==(const FileStamp&) const = default;
};

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
