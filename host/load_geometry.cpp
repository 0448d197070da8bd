#include <glm/gtc/matrix_transform.hpp>

#include "geom/base_mesh_generators.h"
#include "geom/error.h"
#include "host/bundled_tiles.h"
#include "host/world.h"

namespace wale {

namespace {

std::shared_ptr<const MeshSequence> open_sequence(const SequenceSource& source, const Loaders& loaders) {
  if (loaders.sequence) return loaders.sequence(source);
  return std::make_shared<MeshSequence>(source, loaders.mesh);
}

}  // namespace

std::vector<std::filesystem::path> files_of(const MeshSource& s, const Loaders& loaders) {
  if (s.sequence) return open_sequence(*s.sequence, loaders)->files(s.frame);
  return s.file.empty() ? std::vector<std::filesystem::path>{} : std::vector{s.file};
}

BaseMesh load_rest_mesh(const MeshSource& s, const Loaders& loaders) {
  return s.sequence ? open_sequence(*s.sequence, loaders)->rest() : load_mesh(s, loaders);
}

BaseMesh load_mesh(const MeshSource& s, const Loaders& loaders, std::vector<std::string>* notes) {
  if (s.sequence) return open_sequence(*s.sequence, loaders)->at(s.frame, notes);
  if (!s.file.empty()) return loaders.mesh(s.file);
  if (s.generator == "swatch") return make_swatch(s.width, s.height, s.nu, s.nv);
  if (s.generator == "tube") return make_tube(s.radius, s.height, s.nu, s.nv);
  if (s.generator == "pillow") return make_pillow(s.width, s.height, s.thickness, s.nu, s.nv);
  if (s.generator == "beanie") return make_beanie(s.radius, s.height, s.nu, s.nv);
  if (s.generator == "sock") return make_sock(s.radius, s.height, s.length, s.nu, s.nv);
  if (s.generator == "draped_square") return make_draped_square(s.size, s.sphere_radius, s.nu);
  bug("mesh generator \"{}\" passed the schema but has no maker", s.generator);
}

void transform_mesh(BaseMesh& mesh, const Transform& t) {
  glm::dmat4 m(1.0);
  m = glm::rotate(m, t.rotate.z, dvec3(0, 0, 1));
  m = glm::rotate(m, t.rotate.y, dvec3(0, 1, 0));
  m = glm::rotate(m, t.rotate.x, dvec3(1, 0, 0));
  for (auto& p : mesh.position) p = dvec3(m * glm::dvec4(p * t.scale, 1.0)) + t.translate;
  compute_normals(mesh);
}

Pattern load_pattern(const PatternSource& s) {
  if (!s.file.empty()) return read_pattern(s.file, s.hints);
  if (s.builtin == "stockinette" || s.builtin.empty()) return stockinette_pattern();
  return parse_pattern(embedded_tiles().at(s.builtin + ".json"), s.builtin + ".json");
}

}  // namespace wale
