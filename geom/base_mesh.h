#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "geom/vec.h"

namespace wale {

/// A triangle mesh with a UV pair per corner. Polygons have been fanned into triangles.
struct BaseMesh {
  std::string name;
  std::vector<dvec3> position;                    ///< metres
  std::vector<dvec3> normal;                      ///< unit, per vertex, angle weighted
  std::vector<std::array<uint32_t, 3>> triangle;  ///< vertex indices
  std::vector<std::array<dvec2, 3>> uv;           ///< per triangle corner; empty when the file carries none
  size_t polygons_split = 0;                      ///< faces of more than three corners that were fanned
  /// The cloth at rest, whose charts give those of this mesh their scale; null: this mesh itself.
  std::shared_ptr<const BaseMesh> rest{};
};

/// What validation found; nothing here is fatal.
struct MeshReport {
  size_t vertices = 0, triangles = 0, polygons_split = 0;
  size_t non_manifold_edges = 0, boundary_edges = 0, seam_edges = 0;
  size_t degenerate_triangles = 0;  ///< zero area in space: kept, never knitted
  size_t zero_area_uv = 0;          ///< zero area in UV: kept, never knitted
  size_t flipped_uv = 0;            ///< against the majority of their chart
  double overlap = 0;               ///< share of the covered UV area that is covered more than once
  double chart_overlap = 0;         ///< the same within single charts, weighted by area: what stays bare
  dvec2 stretch_median{0, 0};       ///< singular values of UV -> space
};

/// Reads OBJ and OFF (in double) or PLY (through OpenMesh, in float). Lengths are taken as metres. Throws
/// a user error naming the file: missing, not a mesh, no faces, NaN or infinite vertices, a face that names no vertex.
/// Meshes without UV are accepted here (props) and refused by require_uv.
BaseMesh read_mesh(const std::filesystem::path& file);

/// The same from the bytes of a file; `file` gives the suffix, and the name for messages.
BaseMesh parse_mesh(std::string_view bytes, const std::filesystem::path& file);

/// Throws the user error that a fabric needs: no UV, or every UV triangle of zero area.
void require_uv(const BaseMesh& mesh);

MeshReport validate(const BaseMesh& mesh);

/// Angle-weighted vertex normals (unit; (0,0,1) where a vertex has no area).
void compute_normals(BaseMesh& mesh);

/// Writes an OBJ with UV, through a temporary name.
void write_obj(const BaseMesh& mesh, const std::filesystem::path& file);

}  // namespace wale
