#pragma once
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "geom/fabric.h"
#include "host/fibre_tables.h"
#include "host/image.h"
#include "host/light_tables.h"
#include "host/scene.h"
#include "shared/wale_types.h"

namespace wale {

/// How files become data. The core library reads no meshes or images itself.
struct Loaders {
  std::function<BaseMesh(const std::filesystem::path&)> mesh;
  std::function<Image(const std::filesystem::path&)> image;
};

/// An effect that a scene has and that is left out because it cannot matter (host/analysis.h).
struct Dropped {
  std::string what, because;
};

/// A scene made concrete on the host: knitted fabrics, triangles, lights and materials, ready to be uploaded. Positions
/// of fabrics are in double; everything in float is relative to `origin`.
struct World {
  dvec3 origin{0, 0, 0};  ///< metres; subtracted from every position before it becomes float
  std::vector<Fabric> fabrics;
  std::vector<MeshReport> fabric_mesh_reports;
  std::vector<WPlyMaterial> ply_materials;
  std::vector<uint32_t> fabric_material;        ///< per fabric, into ply_materials
  FibreTables fibres;                           ///< detail maps of every ply material
  std::vector<WFibreMaterial> fibre_materials;  ///< of fabrics with explicit fibres only
  std::vector<uint32_t> fabric_fibre_material;  ///< per fabric, into fibre_materials; W_NONE without explicit fibres
  std::vector<uint32_t> ply_colors;             ///< per vertex of all fabrics (host/ply_colors.h); empty: none varies
  std::vector<std::string> colored_fabrics;     ///< whose colours vary
  std::vector<float> triangles;                 ///< W_TRIANGLE_WORDS per triangle, see stages/shade_surface.cl
  std::vector<WSphere> spheres;
  std::vector<WSurfaceMaterial> surface_materials;
  LightTables lights;
  WEnvironment environment{};
  EnvironmentTables environment_tables;  ///< empty for a constant environment
  WCamera camera{};
  std::vector<std::string> notes;         ///< what was mended in the input, one line each
  std::vector<std::string> light_names;   ///< per light, for `wale plan`
  std::vector<std::string> triangle_names, sphere_names;  ///< of objects and lights of that shape
  std::vector<Dropped> dropped;           ///< what was left out because it cannot matter
  bool first_hits_only = false;           ///< paths gather nothing after their first hit
  std::map<std::string, double> seconds;  ///< per step of the build

  size_t triangle_count() const { return triangles.size() / kTriangleWords; }
  static constexpr size_t kTriangleWords = 20;
};

using BuildProgress = std::function<void(const std::string& step, double fraction)>;

/// Builds everything that does not need a device. Throws user errors that name the object. `drop`: leave out what
/// cannot matter (host/analysis.h).
World build_world(const Scene& scene, const Loaders& loaders, const BuildProgress& progress = {}, bool drop = true);

/// The mesh that a scene names, generated or read, before its transform.
BaseMesh load_mesh(const MeshSource& source, const Loaders& loaders);

/// Applies scale, rotation and translation; normals are recomputed.
void transform_mesh(BaseMesh& mesh, const Transform& transform);

Pattern load_pattern(const PatternSource& source);

}  // namespace wale
