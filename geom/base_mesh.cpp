#include "geom/base_mesh.h"

#include <cmath>
#include <fstream>

#include "geom/error.h"

namespace wale {

void require_uv(const BaseMesh& mesh) {
  const std::string name = mesh.name.empty() ? "mesh" : mesh.name;
  if (mesh.uv.empty())
    user_error("{}: the mesh has no UV coordinates, which a fabric needs; unwrap it, or use it as a prop", name);
  for (const auto& t : mesh.uv) {
    const dvec2 a = t[1] - t[0], b = t[2] - t[0];
    if (a.x * b.y - a.y * b.x != 0) return;
  }
  user_error("{}: every UV triangle has zero area; unwrap the mesh again", name);
}

void compute_normals(BaseMesh& mesh) {
  mesh.normal.assign(mesh.position.size(), dvec3(0));
  for (const auto& t : mesh.triangle) {
    const dvec3 p[3] = {mesh.position[t[0]], mesh.position[t[1]], mesh.position[t[2]]};
    const dvec3 area = glm::cross(p[1] - p[0], p[2] - p[0]);
    const double size = glm::length(area);
    if (!(size > 0)) continue;
    for (int c = 0; c < 3; ++c) {
      const dvec3 a = p[(c + 1) % 3] - p[c], b = p[(c + 2) % 3] - p[c];
      // Angle by atan2: acos loses half the digits of thin corners.
      mesh.normal[t[static_cast<size_t>(c)]] += std::atan2(size, glm::dot(a, b)) / size * area;
    }
  }
  for (dvec3& n : mesh.normal) {
    const double size = glm::length(n);
    n = size > 1e-12 ? n / size : dvec3(0, 0, 1);
  }
}

void write_obj(const BaseMesh& mesh, const std::filesystem::path& file) {
  const std::filesystem::path temporary = file.string() + ".part";
  {
    std::ofstream out(temporary, std::ios::binary);
    std::string text;
    for (const dvec3& p : mesh.position) text += fmt::format("v {} {} {}\n", p.x, p.y, p.z);
    for (const auto& t : mesh.uv)
      for (const dvec2& uv : t) text += fmt::format("vt {} {}\n", uv.x, uv.y);
    for (size_t i = 0; i < mesh.triangle.size(); ++i) {
      const auto& t = mesh.triangle[i];
      if (mesh.uv.empty())
        text += fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
      else
        text += fmt::format("f {}/{} {}/{} {}/{}\n", t[0] + 1, 3 * i + 1, t[1] + 1, 3 * i + 2, t[2] + 1, 3 * i + 3);
    }
    out << text;
    if (!out.flush()) user_error("{}: cannot be written; check the folder and the space left", file.string());
  }
  std::error_code error;
  std::filesystem::rename(temporary, file, error);
  if (error) user_error("{}: cannot be written: {}", file.string(), error.message());
}

}  // namespace wale
