#include "host/scene_device.h"

#include <algorithm>

#include "geom/error.h"
#include "host/driver_crash.h"
#include "host/features.h"
#include "host/triangle_tree.h"
#include "shared/visits.h"

namespace wale {
namespace {

// Triangles are renumbered so that every leaf of their tree holds a run.
std::vector<float> in_order(const std::vector<float>& triangles, const std::vector<uint32_t>& order) {
  constexpr size_t kWords = World::kTriangleWords;
  std::vector<float> out;
  out.reserve(triangles.size());
  for (const uint32_t t : order)
    out.insert(out.end(), triangles.begin() + std::ptrdiff_t(t * kWords),
               triangles.begin() + std::ptrdiff_t((t + 1) * kWords));
  return out;
}

std::vector<float> corners_of(const std::vector<float>& triangles) {
  constexpr size_t kWords = World::kTriangleWords;
  std::vector<float> out;
  out.reserve(triangles.size() / kWords * 9);
  for (size_t i = 0; i < triangles.size(); i += kWords)
    out.insert(out.end(), triangles.begin() + std::ptrdiff_t(i), triangles.begin() + std::ptrdiff_t(i + 9));
  return out;
}

}  // namespace

std::vector<FabricInput> fabric_inputs(const World& world) {
  std::vector<FabricInput> inputs;
  for (size_t i = 0; i < world.fabrics.size(); ++i)
    inputs.push_back({&world.fabrics[i], world.fabric_material[i], world.ply_materials[world.fabric_material[i]].tau_e,
                      world.fabric_fibre_material[i]});
  return inputs;
}

SceneDevice::Surfaces::Surfaces(const Device& device, const std::vector<float>& from, bool simt) : words(from) {
  const TriangleTree tree = build_triangle_tree(corners_of(words));
  const bool any = !tree.order.empty();
  triangles = Buffer<float>(device, in_order(words, tree.order));
  nodes = any ? Buffer<uint32_t>(device, tree.tree.words) : Buffer<uint32_t>(device, 0);
  leaves = any ? Buffer<float>(device, tree.leaves) : Buffer<float>(device, 0);
  if (any) root = 0;
  if (simt) {
    quantised = QuantisedTree(device, any ? tree.tree : WideTree{}, nodes);
    nodes = Buffer<uint32_t>(device, 0);
  }
}

std::vector<MeshPlace> places_of(const World& world) {
  std::vector<MeshPlace> places;
  for (const Knitting& knitting : world.knittings)
    if (knitting.place) places.push_back(*knitting.place);
  return places;
}

SceneDevice::FabricKey SceneDevice::fabric_key(const World& world) {
  FabricKey key{{}, world.origin, world.local_stage, world.leaf_form};
  const std::vector<FabricInput> inputs = fabric_inputs(world);
  for (size_t i = 0; i < inputs.size(); ++i)
    key.parts.push_back({world.knittings[i].number, inputs[i].material, inputs[i].fibre_material, inputs[i].tau});
  return key;
}

SceneDevice::SceneDevice(const Device& device, const World& world, const SceneDevice* previous,
                         const SceneDeviceOptions& options)
    : device_(device), simt_(quantised_tree(device.traits(), world.local_stage)), key_(fabric_key(world)) {
  shares_fabrics_ = previous && previous->key_ == key_ && previous->fabrics_->somewhere;
  const std::vector<MeshPlace> places = places_of(world);
  const std::vector<FabricInput> inputs = fabric_inputs(world);
  const bool lattice =
      std::any_of(inputs.begin(), inputs.end(), [](const auto& i) { return !i.fabric->lattice.empty(); });
  const bool updatable = options.updatable || (!places.empty() && !lattice && world.local_stage == LocalStage::exact);
  if (shares_fabrics_ && previous->fabrics_->places != places) shares_fabrics_ = previous->fabric().warp != nullptr;
  const DriverCall guard;
  if (!shares_fabrics_) {
    fabrics_ = std::make_shared<Fabrics>(
        Fabrics{upload_fabrics(device, inputs, world.origin, world.local_stage, updatable, world.leaf_form), places});
  } else {
    fabrics_ = previous->fabrics_;
    moved_fabrics_ = fabrics_->places != places;
  }
  if (previous && previous->simt_ == simt_ && previous->surfaces_->words == world.triangles)
    surfaces_ = previous->surfaces_;
  else
    surfaces_ = std::make_shared<Surfaces>(device, world.triangles, simt_);
  ply_materials_ = Buffer<WPlyMaterial>(device, world.ply_materials);
  fibre_details_ = Buffer<WFibreDetail>(device, world.fibres.details);
  fibre_offsets_ = Buffer<uint32_t>(device, world.fibres.offsets);
  fibre_candidates_ = Buffer<w_float4>(device, world.fibres.candidates);
  fibre_materials_ = Buffer<WFibreMaterial>(device, world.fibre_materials);
  ply_colors_ = Buffer<uint32_t>(device, world.ply_colors);
  spheres_ = Buffer<WSphere>(device, world.spheres);
  sphere_count_ = uint32_t(world.spheres.size());
  surface_materials_ = Buffer<WSurfaceMaterial>(device, world.surface_materials);
  lights_ = Buffer<WLight>(device, world.lights.lights);
  light_count_ = uint32_t(world.lights.lights.size());
  samples_lights_ = world.lights.any();
  light_cdf_ = Buffer<float>(device, world.lights.cdf);
  light_triangles_ = Buffer<float>(device, world.lights.triangles);
  light_triangle_index_ = Buffer<int32_t>(device, world.lights.triangle_index);
  environment_ = world.environment;
  env_texels_ = Buffer<w_float4>(device, world.environment_tables.texels);
  env_cdf_ = Buffer<float>(device, world.environment_tables.cdf);
  events_ = Buffer<uint32_t>(device, W_COUNTER_COUNT);
  events_.fill(device, 0u);
  // Last: the version before has the same fabrics, and keeps them where they are when anything above fails.
  if (moved_fabrics_) move_fabrics(inputs, world.origin, places);
}

void SceneDevice::move_fabrics(const std::vector<FabricInput>& inputs, const dvec3& origin,
                               const std::vector<MeshPlace>& places) {
  const MeshVertices mesh = mesh_vertices(inputs, origin);
  fabrics_->somewhere = false;
  update_fabrics(device_, fabrics_->device, mesh.positions, mesh.normals);
  fabrics_->places = places;
  fabrics_->somewhere = true;
}

cl_uint SceneDevice::bind_scene(cl::Kernel& kernel, cl_uint first, bool procedural) const {
  cl_uint i = first;
  kernel.setArg(i++, fabric().tree.ray_nodes().cl());
  kernel.setArg(i++, fabric().tree.node_cell.cl());
  kernel.setArg(i++, fabric().tree.leaves.parts().front().words.cl());
  kernel.setArg(i++, fabric().tree.root);
  kernel.setArg(i++, surfaces_->root);
  kernel.setArg(i++, simt_ ? surfaces_->quantised.nodes().cl() : surfaces_->nodes.cl());
  kernel.setArg(i++, surfaces_->leaves.cl());
  kernel.setArg(i++, spheres_.cl());
  kernel.setArg(i++, sphere_count_);
  kernel.setArg(i++, events_.cl());
  if (simt_) {
    kernel.setArg(i++, fabric().tree.quantised.leaf_boxes().cl());
    kernel.setArg(i++, surfaces_->quantised.leaf_boxes().cl());
  }
  if (fabric().tree.leaves.split()) i = fabric().tree.leaves.bind_others(kernel, i);
  if (procedural) {
    kernel.setArg(i++, fabric().lattice.lattice.cl());
    kernel.setArg(i++, fabric().lattice.tiles.cl());
    kernel.setArg(i++, fabric().lattice.patch_bits);
  }
  if (key_.stage != LocalStage::exact) {
    kernel.setArg(i++, fabric().base_positions.cl());
    kernel.setArg(i++, fabric().base_indices.cl());
    kernel.setArg(i++, fabric().base_uv.cl());
    kernel.setArg(i++, fabric().cell_triangle_offsets.cl());
    kernel.setArg(i++, fabric().cell_triangles.cl());
    kernel.setArg(i++, fabric().cell_segment_offsets.cl());
    kernel.setArg(i++, fabric().cell_segments.cl());
    kernel.setArg(i++, fabric().grids.cl());
    kernel.setArg(i++, fabric().grid_of_cell.cl());
  }
  return i;
}

cl_uint SceneDevice::bind_lights(cl::Kernel& kernel, cl_uint first) const {
  cl_uint i = first;
  kernel.setArg(i++, lights_.cl());
  kernel.setArg(i++, light_cdf_.cl());
  kernel.setArg(i++, light_triangles_.cl());
  kernel.setArg(i++, light_triangle_index_.cl());
  kernel.setArg(i++, environment_);
  kernel.setArg(i++, env_texels_.cl());
  kernel.setArg(i++, env_cdf_.cl());
  kernel.setArg(i++, light_count_);
  return i;
}

cl_uint SceneDevice::bind_ply_colors(cl::Kernel& kernel, cl_uint first) const {
  kernel.setArg(first, ply_colors_.cl());
  kernel.setArg(first + 1, cl_uint(ply_colors_.count()));
  return first + 2;
}

std::map<std::string, uint64_t> SceneDevice::bytes() const {
  const uint64_t frames = fabric().frames.bytes(), leaves = fabric().tree.leaves.bytes();
  const uint64_t tree = fabric().tree.tree_bytes();
  return {{"ply vertices", frames},
          {"ply leaves", leaves},
          {"lattices", fabric().lattice.bytes()},
          {"ply tree", tree},
          {"triangles", surfaces_->triangles.bytes() + surfaces_->leaves.bytes() + surfaces_->nodes.bytes() +
                            surfaces_->quantised.bytes()},
          {"environment", env_texels_.bytes() + env_cdf_.bytes()},
          {"lights", lights_.bytes() + light_cdf_.bytes() + light_triangles_.bytes()},
          {"fibre detail", fibre_details_.bytes() + fibre_offsets_.bytes() + fibre_candidates_.bytes()},
          {"materials", ply_materials_.bytes() + fibre_materials_.bytes() + surface_materials_.bytes()},
          {"ply colours", ply_colors_.bytes()},
          {"UV cells", fabric().bytes - frames - leaves - tree}};
}

}  // namespace wale
