#pragma once
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "geom/fabric.h"
#include "host/fibre_tables.h"
#include "host/image.h"
#include "host/kept_meshes.h"
#include "host/knit_order.h"
#include "host/leaf_form.h"
#include "host/light_tables.h"
#include "host/local_stage.h"
#include "host/scene.h"
#include "shared/wale_types.h"

namespace wale {

/// How files become data. The core library reads no meshes or images itself.
struct Loaders {
  std::function<BaseMesh(const std::filesystem::path&)> mesh;
  std::function<Image(const std::filesystem::path&)> image;
  /// Keeps sequences open from frame to frame; absent: they are opened for every frame.
  std::function<std::shared_ptr<const MeshSequence>(const SequenceSource&)> sequence{};
};

/// An effect that a scene has and that is left out because it cannot matter (host/analysis.h).
struct Dropped {
  std::string what, because;
};

/// Where a fabric comes from.
struct Knitting {
  KnitOrder order;
  uint64_t number = 0;             ///< of this program's knittings, from 1 on: two fabrics with one number are the same
  std::vector<std::string> notes;  ///< what was mended or chosen, one line each
  std::optional<MeshPlace> place;  ///< of a fabric that follows its mesh; absent: it was knitted where it is
};

/// What an appearance becomes on the device: solved for its colour, which takes as long as moving a fabric.
struct MadeYarn {
  PlyAppearance from;
  WPlyMaterial ply;
  std::optional<WFibreMaterial> fibre;  ///< where fibres are explicit
};

/// A scene made concrete on the host: knitted fabrics, triangles, lights and materials, ready to be uploaded. Positions
/// of fabrics are in double; everything in float is relative to `origin`.
struct World {
  dvec3 origin{0, 0, 0};  ///< metres; subtracted from every position before it becomes float
  std::vector<Fabric> fabrics;
  std::vector<Knitting> knittings;  ///< per fabric
  std::vector<MeshReport> fabric_mesh_reports;
  std::vector<MadeYarn> made_yarns;  ///< per fabric, before anything was dropped
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
  KeptMeshes kept_meshes;                                 ///< of props and lights
  std::vector<std::string> notes;                         ///< what was mended in the input, one line each
  std::vector<std::string> light_names;                   ///< per light, for `wale plan`
  std::vector<std::string> triangle_names, sphere_names;  ///< of objects and lights of that shape
  std::vector<Dropped> dropped;                           ///< what was left out because it cannot matter
  bool first_hits_only = false;                           ///< paths gather nothing after their first hit
  LocalStage local_stage = LocalStage::exact;
  LeafForm leaf_form;
  std::map<std::string, double> seconds;  ///< per step of the build

  size_t triangle_count() const { return triangles.size() / kTriangleWords; }
  static constexpr size_t kTriangleWords = 20;
};

using BuildProgress = std::function<void(const std::string& step, double fraction)>;

struct WorldOptions {
  bool drop = true;       ///< leave out what cannot matter (host/analysis.h)
  bool editable = false;  ///< keep what another version's colours need
  World* previous =
      nullptr;  ///< an earlier version, whose fabrics are taken where they are the same; it keeps the rest
};

/// Builds everything that does not need a device. Throws user errors that name the object, and leaves the earlier
/// version as it was then.
World build_world(const Scene& scene, const Loaders& loaders, const BuildProgress& progress = {},
                  const WorldOptions& options = {});

/// Puts the fabrics that build_world() took from an earlier version back into it.
void give_back_fabrics(World& from, World& previous);

/// The mesh that a scene names, generated or read, before its transform. Frames that are held add a line to `notes`.
BaseMesh load_mesh(const MeshSource& source, const Loaders& loaders, std::vector<std::string>* notes = nullptr);

/// Files and folders that it depends on.
std::vector<std::filesystem::path> files_of(const MeshSource& source, const Loaders& loaders);

/// The same at rest, if it is one of a sequence.
BaseMesh load_rest_mesh(const MeshSource& source, const Loaders& loaders);

/// Applies scale, rotation and translation; normals are recomputed.
void transform_mesh(BaseMesh& mesh, const Transform& transform);

Pattern load_pattern(const PatternSource& source);

}  // namespace wale
