#include "geom/polygon_soup.h"

#include <cmath>

#include "geom/error.h"

namespace wale {

BaseMesh triangulate(const PolygonSoup& soup, const std::string& file) {
  for (size_t i = 0; i < soup.position.size(); ++i) {
    const dvec3 p = soup.position[i];
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
      user_error("{}: vertex {}: position is NaN or infinite; write a finite number", file, i + 1);
  }
  for (size_t i = 0; i < soup.uv.size(); ++i)
    if (!std::isfinite(soup.uv[i].x) || !std::isfinite(soup.uv[i].y))
      user_error("{}: texture coordinate {}: NaN or infinite; write a finite number", file, i + 1);

  BaseMesh mesh;
  mesh.position = soup.position;
  bool any_uv = false;
  for (const int64_t i : soup.uv_index) any_uv = any_uv || i >= 0;

  const auto corner_uv = [&](size_t corner) {
    const int64_t i = soup.uv_index[corner];
    return i < 0 ? dvec2(0) : soup.uv[static_cast<size_t>(i)];
  };
  for (size_t f = 0; f < soup.face_begin.size(); ++f) {
    const size_t begin = soup.face_begin[f];
    const size_t end = f + 1 < soup.face_begin.size() ? soup.face_begin[f + 1] : soup.vertex.size();
    if (end - begin > 3) ++mesh.polygons_split;
    for (size_t c = begin + 1; c + 1 < end; ++c) {
      mesh.triangle.push_back({soup.vertex[begin], soup.vertex[c], soup.vertex[c + 1]});
      if (any_uv) mesh.uv.push_back({corner_uv(begin), corner_uv(c), corner_uv(c + 1)});
    }
  }
  if (mesh.triangle.empty()) user_error("{}: not a mesh: no faces; give an OBJ, PLY or OFF file with triangles", file);
  compute_normals(mesh);
  return mesh;
}

}  // namespace wale
