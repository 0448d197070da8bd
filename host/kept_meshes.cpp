#include "host/kept_meshes.h"

#include "host/world.h"

namespace wale {
namespace {

bool unchanged(const std::vector<FileStamp>& files) {
  for (const FileStamp& stamp : files)
    if (!stamp.settled || stamp_of(stamp.file) != stamp) return false;
  return true;
}

}  // namespace

std::shared_ptr<const BaseMesh> KeptMeshes::load(const MeshSource& source, const Loaders& loaders,
                                                 const KeptMeshes* earlier, std::vector<std::string>& notes) {
  std::shared_ptr<const Kept> found;
  for (const KeptMeshes* meshes : {static_cast<const KeptMeshes*>(this), earlier})
    for (size_t i = 0; meshes && !found && i < meshes->kept_.size(); ++i)
      if (meshes->kept_[i]->source == source && unchanged(meshes->kept_[i]->files)) found = meshes->kept_[i];
  if (!found) {
    auto made = std::make_shared<Kept>(Kept{source, {}, {}, {}});
    Loaders once = loaders;  // opens a sequence but once
    if (source.sequence && !once.sequence)
      once.sequence = [open = std::make_shared<const MeshSequence>(*source.sequence, loaders.mesh)](const auto&) {
        return open;
      };
    // Stamped before it is read: what changes meanwhile is read again.
    for (const auto& file : files_of(source, once)) made->files.push_back(stamp_of(file));
    made->mesh = std::make_shared<BaseMesh>(load_mesh(source, once, &made->notes));
    found = std::move(made);
  }
  kept_.push_back(found);
  notes.insert(notes.end(), found->notes.begin(), found->notes.end());
  return found->mesh;
}

}  // namespace wale
