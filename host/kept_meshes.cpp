#include "host/kept_meshes.h"

#include <sys/stat.h>

#include <chrono>

#include "host/world.h"

namespace wale {
namespace {

FileStamp stamp_of(const std::filesystem::path& file) {
  constexpr std::chrono::seconds kTick{2};  // of the coarsest clock of files
  std::error_code failed;                   // a file that has gone is stamped too
  FileStamp out{file};
  out.changed = std::filesystem::last_write_time(file, failed);
  out.settled = failed || std::filesystem::file_time_type::clock::now() - out.changed > kTick;
  if (std::filesystem::is_regular_file(file, failed)) out.bytes = std::filesystem::file_size(file, failed);
  if (struct stat status; ::stat(file.c_str(), &status) == 0) out.number = status.st_ino;
  return out;
}

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
