#pragma once
#include <string>
#include <vector>

#include "host/fabric_device.h"
#include "shared/normals.h"
#include "shared/wale_types.h"

namespace wale {

struct World;
struct Scene;
struct IntegratorScene;

/// Frames that plies are shaded with: W_NORMALS_* of kernels/shared/normals.h.
enum class Normals : uint32_t {
  flat = W_NORMALS_FLAT,
  linear = W_NORMALS_LINEAR,
  rotation_minimising = W_NORMALS_ROTATION_MINIMISING
};

/// What a scene asks for. Structure that is absent is neither compiled, launched nor stored; values are run-time data.
struct Features {
  bool plies = false, fibres = false;  ///< curves shaded as plies, and as single fibres
  bool triangles = false, spheres = false;
  bool environment = false, lights = false;  ///< lights: something is sampled by next-event estimation
  bool detail = false;                       ///< fibres show on plies, by maps
  bool paper_lobes = false;                  ///< bodies of plies are Lambert lobes
  bool quantised_vertices = false;           ///< leaves that are stored keep 16 bits a coordinate
  bool double_precision = false;             ///< rays and shading in double, one lane
  bool relaxed_math = false;                 ///< the compiler may reorder and approximate
  bool aovs = false;
  bool gradients = false;       ///< derivatives by the ply material, in the place of feature images
  bool mesh_warp = false;       ///< some plies are warped by the base mesh itself
  bool stored_lattice = false;  ///< some are warped by a lattice, and stored
  bool procedural = false;      ///< some leaves keep no points
  bool ply_colors = false;      ///< colours that vary over the cloth
  LocalStage local_stage = LocalStage::exact;
  Normals normals = Normals::rotation_minimising;  ///< a value: no definition
  int lanes = 1;
  bool simt = false;  ///< rays go down quantised nodes, one per work-item

  /// Four vectors a path and a pixel beside the radiance.
  bool four_vectors() const { return aovs || gradients; }

  /// Camera rays go in packets of `lanes` (kernels/geometry/traverse_packet.clh).
  bool packets() const { return (plies || fibres) && local_stage == LocalStage::exact && lanes == W_NODE_WIDTH; }

  /// Definitions for the kernels.
  std::string options() const;

  /// The same with the structure of others built in too, whether the scene has it or not; what is a choice (local
  /// stage, lobes, arithmetic, lanes) stays as it is. The picture is the same, bit for bit.
  Features with(const Features& others) const;
  /// Every structure that may be built in.
  static Features everything();
};

/// One decision and the object or key that asks for it; the lines of `wale plan`.
struct Reason {
  std::string feature;
  bool used = false;
  std::string because;
};

/// The tree of such a device is quantised, for scenes of this local stage: the cheaper ones need cells in the tree.
bool quantised_tree(const DeviceTraits& traits, LocalStage stage);
/// Stage that a scene's integrator.local_stage names.
LocalStage local_stage(const IntegratorScene& integrator);
/// What a scene's integrator.joints and integrator.vertices name.
LeafForm leaf_form(const IntegratorScene& integrator);
Features analyse(const World& world, const IntegratorScene& integrator, bool aovs, const DeviceTraits& traits);
/// The same from the scene alone, before anything is knitted: what analyse() will say, unless a fabric turns out empty
/// or so large that it is held procedurally unasked. For programs that are compiled ahead (host/rehearsal.h); nothing
/// else may rest on it.
Features foresee(const Scene& scene, bool aovs, const DeviceTraits& traits);
std::vector<Reason> explain(const World& world, const IntegratorScene& integrator, const Features& features);

}  // namespace wale
