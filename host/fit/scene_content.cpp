#include "host/fit/scene_content.h"

#include <fmt/format.h>

#include <cmath>

#include "geom/byte_source.h"
#include "geom/numbered_name.h"
#include "host/fit/material_json.h"
#include "host/scene_identity.h"

namespace wale::fit {
namespace {

using Files = std::vector<std::filesystem::path>;

void add(Files& files, const std::filesystem::path& file) {
  if (!file.empty()) files.push_back(file);
}

void add(Files& files, const MeshSource& mesh, double shutter) {
  add(files, mesh.file);
  if (!mesh.sequence) return;
  const SequenceSource& source = *mesh.sequence;
  add(files, source.base);
  add(files, source.cache);
  if (!source.cache.empty() || !NumberedName::is_one(source.frames)) return add(files, source.frames);
  const NumberedName name(source.frames);
  const auto of = [&](long frame) { return name.file(source.first + frame * source.step); };
  add(files, of(source.rest));
  const long last = std::lround(std::ceil(mesh.frame + shutter));
  for (long frame = std::lround(std::floor(mesh.frame)); frame <= last; ++frame) add(files, of(frame));
}

// What a fitted material has not: colours that vary.
std::string variation_words(const PlyAppearance& yarn) {
  std::string out = fmt::format("{} {}", yarn.heather_yarn, yarn.heather_ply);
  for (const Rgb& c : yarn.plies) out += fmt::format(" ply {} {} {}", c[0], c[1], c[2]);
  for (const Stripe& s : yarn.stripes)
    out += fmt::format(" stripe {} {} {} {}", s.length, s.color[0], s.color[1], s.color[2]);
  return out;
}

}  // namespace

std::vector<std::filesystem::path> files_of(const Scene& scene) {
  Files files;
  const double shutter = scene.animation.shutter;
  for (const FabricScene& fabric : scene.fabrics) {
    add(files, fabric.mesh, shutter);
    add(files, fabric.pattern.file);
    add(files, fabric.color_image.file);
  }
  for (const ObjectScene& object : scene.objects) add(files, object.mesh, shutter);
  for (const LightScene& light : scene.lights) {
    add(files, light.mesh, shutter);
    add(files, light.file);
  }
  return files;
}

std::string model_words(const Scene& scene) {
  std::string out = accuracy_settings(scene);
  // Of several fabrics together it may say no more than "mixed".
  Scene one = scene;
  for (const FabricScene& fabric : scene.fabrics) {
    one.fabrics = {fabric};
    out += '\n';
    out += accuracy_settings(one);
  }
  for (size_t i = 0; i < scene.materials.size(); ++i) {
    if (!scene.materials[i].ply) continue;
    out += material_json(scene, {.material = i, .fabrics = {}});
    out += variation_words(scene.materials[i].yarn);
  }
  return out;
}

uint64_t hash_file(const std::filesystem::path& file, uint64_t seed) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) return hash_bytes("0 ", seed);
  const ByteSource source = ByteSource::of_file(file);
  return hash_bytes(source, 0, source.size(), hash_bytes(fmt::format("{} ", source.size()), seed));
}

}  // namespace wale::fit
