#include "host/frame_identity.h"

#include <fmt/format.h>

#include "host/scene_identity.h"

namespace wale {

std::shared_ptr<const MeshSequence> OpenSequences::open(const SequenceSource& source) {
  for (const auto& sequence : open_)
    if (sequence->source() == source) return sequence;
  open_.push_back(std::make_shared<MeshSequence>(source, read_));
  return open_.back();
}

uint64_t FrameIdentity::file(const std::filesystem::path& file) {
  if (file.empty()) return 0;
  const auto known = files_.find(file);
  if (known != files_.end()) return known->second;
  const ByteSource source = ByteSource::of_file(file);
  return files_[file] = hash_bytes(source, 0, source.size());
}

uint64_t FrameIdentity::mesh(const MeshSource& mesh, double shutter) {
  if (!mesh.sequence) return file(mesh.file);
  const auto sequence = sequences_.open(*mesh.sequence);
  const uint64_t base = mesh.sequence->base.empty() ? 0 : file(mesh.sequence->base);
  uint64_t all = base ^ sequence->hash(mesh.frame);
  if (shutter > 0) {
    // Frames in the middle are seen too, and samples of a cache may lie closer to each other than frames.
    for (double open = 1; open < shutter; ++open) all = all * 31 + sequence->hash(mesh.frame + open);
    if (!mesh.sequence->cache.empty()) all = all * 31 + file(mesh.sequence->cache);
    all = all * 31 + sequence->hash(mesh.frame + shutter);
  }
  return all;
}

std::string FrameIdentity::of(const Scene& scene, const std::vector<std::string>& overrides) {
  const IntegratorScene& i = scene.integrator;
  const FilmScene& film = scene.film;
  std::string text = fmt::format("{} {} {} {} {} {} {}x{} {} {} {}", scene_identity(args_.scene, overrides),
                                 accuracy_settings(scene), most_samples(args_, i), args_.error, args_.seconds, i.seed,
                                 film.width, film.height, film.filter, film.exposure, film.view);
  const double shutter = scene.animation.shutter;
  for (const FabricScene& fabric : scene.fabrics)
    text += fmt::format(" {:x} {:x} {:x}", mesh(fabric.mesh, shutter), file(fabric.pattern.file),
                        file(fabric.color_image.file));
  for (const ObjectScene& object : scene.objects) text += fmt::format(" {:x}", mesh(object.mesh, shutter));
  for (const LightScene& light : scene.lights)
    text += fmt::format(" {:x} {:x}", mesh(light.mesh, shutter), file(light.file));
  return fmt::format("{:016x}", hash_bytes(text));
}

}  // namespace wale
