#include "host/frame_identity.h"

#include <fmt/format.h>

#include <cmath>

#include "geom/error.h"
#include "geom/numbered_name.h"
#include "host/scene_identity.h"

namespace wale {

std::shared_ptr<const MeshSequence> OpenSequences::open(const SequenceSource& source) {
  for (const auto& sequence : open_)
    if (sequence->source() == source) return sequence;
  open_.push_back(std::make_shared<MeshSequence>(source, read_));
  return open_.back();
}

namespace {

uint64_t hash_of(const std::filesystem::path& file) {
  const ByteSource source = ByteSource::of_file(file);
  return hash_bytes(source, 0, source.size());
}

}  // namespace

uint64_t FrameIdentity::file(const std::filesystem::path& file) {
  if (file.empty()) return 0;
  const auto known = files_.find(file);
  if (known != files_.end()) return known->second.hash;
  const FileStamp stamp = stamp_of(file);
  return (files_[file] = {stamp, hash_of(file)}).hash;
}

// Of numbered files those of one frame are hashed for it; the rest stays in memory.
void FrameIdentity::stamp(const MeshSequence& sequence, double from, double to) {
  const SequenceSource& source = sequence.source();
  const auto once = [&](const std::filesystem::path& file) { sequence_files_.try_emplace(file, stamp_of(file)); };
  if (!source.cache.empty()) return once(source.cache);
  if (!NumberedName::is_one(source.frames)) return once(source.frames);
  const NumberedName name(source.frames);
  const auto of = [&](double frame) { return name.file(source.first + std::lround(frame) * source.step); };
  once(of(double(source.rest)));
  for (double frame = std::floor(from); frame <= std::ceil(to); ++frame) frame_files_.push_back(stamp_of(of(frame)));
}

uint64_t FrameIdentity::mesh(const MeshSource& mesh, double shutter) {
  if (!mesh.sequence) return file(mesh.file);
  const auto sequence = sequences_.open(*mesh.sequence);
  stamp(*sequence, mesh.frame, mesh.frame + shutter);
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

// A young file may have changed and have the time that it had.
bool FrameIdentity::same(Hashed& file) const {
  const FileStamp now = stamp_of(file.stamp.file);
  if (now != file.stamp) return false;
  if (file.stamp.settled) return true;
  try {
    if (hash_of(now.file) != file.hash) return false;
  } catch (const Error& error) {  // it has just gone
    if (error.fault() != Fault::user) throw;
    return false;
  }
  file.stamp = now;
  return true;
}

const std::optional<std::filesystem::path>& FrameIdentity::changed() {
  const auto check = [&](const FileStamp& stamp) {
    if (!changed_ && stamp_of(stamp.file) != stamp) changed_ = stamp.file;
  };
  for (auto& [name, file] : files_)
    if (!changed_ && !same(file)) changed_ = name;
  for (const auto& [name, stamp] : sequence_files_) check(stamp);
  for (const FileStamp& stamp : frame_files_) check(stamp);
  return changed_;
}

std::string FrameIdentity::of(const Scene& scene, const std::vector<std::string>& overrides) {
  changed();  // of the frame before
  frame_files_.clear();
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
