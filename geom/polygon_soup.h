#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "geom/base_mesh.h"

namespace wale {

/// Faces as a file lists them, before they become triangles. No connectivity, so that non-manifold input is no special
/// case.
struct PolygonSoup {
  std::vector<dvec3> position;
  std::vector<dvec2> uv;
  std::vector<uint32_t> face_begin;  ///< first corner of every face; the end is the next face's begin
  std::vector<uint32_t> vertex;      ///< per corner
  std::vector<int64_t> uv_index;     ///< per corner, -1 where the file gives none; may be empty
};

/// Fans every polygon from its first corner. Corners without UV get (0,0), which makes their triangles zero-area in UV;
/// a soup without any UV gives a mesh without UV. Throws a user error naming `file` for no faces, NaN or infinity.
BaseMesh triangulate(const PolygonSoup& soup, const std::string& file);

/// OBJ in double: v, vt, f (polygons, negative indices); every other keyword is skipped. Throws a user error file:line.
PolygonSoup parse_obj(std::string_view text, const std::string& file);

/// Text OFF in double, with texture coordinates and comments; normals, and colours of vertices and faces, are skipped.
/// Throws a user error file:line where an element is missing, its line holds too few numbers, or one of them is none
/// that a float can hold. Not by OpenMesh: it takes a face's colour, or comment, for the faces that follow.
/// Format: Geomview manual, "OFF: Object File Format".
PolygonSoup parse_off(std::string_view text, const std::string& file);

}  // namespace wale
