#pragma once
#include <memory>

#include "host/device.h"
#include "host/fabric_device.h"
#include "host/world.h"

namespace wale {

/// The world's fabrics and what they are made of.
std::vector<FabricInput> fabric_inputs(const World& world);

struct SceneDeviceOptions {
  bool updatable = false;  ///< see upload_fabrics()
};

/// A world on the device: buffers and the order in which kernels take them (stages/scene_args.clh, light_args.clh).
class SceneDevice {
 public:
  SceneDevice(const Device& device, const World& world) : SceneDevice(device, world, nullptr, {}) {}

  /// The same, sharing with an earlier version on this device what did not change.
  SceneDevice(const Device& device, const World& world, const SceneDevice* previous, const SceneDeviceOptions& options);

  /// Definitions for the kernels that follow from how the world lies on the device, beside those of its features.
  std::string options() const { return fabric().tree.leaves.split() ? " -DW_SPLIT_LEAVES" : ""; }

  /// Set the arguments of W_SCENE_PARAMS / W_LIGHT_PARAMS from `first` on; return the next free index. Kernels must be
  /// built for the same features and with options(); `procedural`: for procedural leaves, whether there are any or not.
  cl_uint bind_scene(cl::Kernel& kernel, cl_uint first, bool procedural) const;
  cl_uint bind_lights(cl::Kernel& kernel, cl_uint first) const;
  /// W_COLOR_PARAMS of the stages that shade curves.
  cl_uint bind_ply_colors(cl::Kernel& kernel, cl_uint first) const;

  const cl::Buffer& frames() const { return fabric().frames.cl(); }
  const cl::Buffer& ply_materials() const { return ply_materials_.cl(); }
  const cl::Buffer& fibre_details() const { return fibre_details_.cl(); }
  const cl::Buffer& fibre_offsets() const { return fibre_offsets_.cl(); }
  const cl::Buffer& fibre_candidates() const { return fibre_candidates_.cl(); }
  const cl::Buffer& fibre_materials() const { return fibre_materials_.cl(); }
  const cl::Buffer& triangles() const { return surfaces_->triangles.cl(); }
  const cl::Buffer& spheres() const { return spheres_.cl(); }
  const cl::Buffer& surface_materials() const { return surface_materials_.cl(); }
  const cl::Buffer& events() const { return events_.cl(); }
  /// Rare events, and the visits of programs that count them (kernels/shared/visits.h).
  std::vector<uint32_t> read_events() const { return events_.read(device_); }

  /// Some light may be sampled; false where all of them were dropped.
  bool samples_lights() const { return samples_lights_; }
  const FabricDevice& fabric() const { return fabrics_->device; }
  /// The fabrics are those of the earlier version; which then has them where this one has.
  bool shares_fabrics() const { return shares_fabrics_; }
  /// And they were warped on to meshes that had moved.
  bool moved_fabrics() const { return moved_fabrics_; }
  /// Bytes by buffer name, for `wale plan` and --stats.
  std::map<std::string, uint64_t> bytes() const;

 private:
  const Device& device_;
  bool simt_;
  /// What the fabrics on the device follow from.
  struct FabricKey {
    struct Part {
      uint64_t knitting = 0;
      uint32_t material = 0, fibre_material = 0;
      float tau = 0;
      bool operator==(const Part&) const = default;
    };
    std::vector<Part> parts;
    dvec3 origin{0, 0, 0};
    LocalStage stage = LocalStage::exact;
    LeafForm form;
    bool operator==(const FabricKey&) const = default;
  };
  static FabricKey fabric_key(const World& world);
  void move_fabrics(const std::vector<FabricInput>& inputs, const dvec3& origin, const std::vector<MeshPlace>& places);

  FabricKey key_;
  bool shares_fabrics_ = false, moved_fabrics_ = false;
  /// Fabrics and where they are: versions that share them can move them.
  struct Fabrics {
    FabricDevice device;
    std::vector<MeshPlace> places;  ///< of those that follow their mesh
    bool somewhere = true;          ///< false after a failure in moving them
  };
  std::shared_ptr<Fabrics> fabrics_;
  Buffer<WPlyMaterial> ply_materials_;
  Buffer<WFibreDetail> fibre_details_;
  Buffer<uint32_t> fibre_offsets_;
  Buffer<w_float4> fibre_candidates_;
  Buffer<WFibreMaterial> fibre_materials_;
  Buffer<uint32_t> ply_colors_;
  /// Triangles of objects and lights, and their tree.
  struct Surfaces {
    Surfaces(const Device& device, const std::vector<float>& words, bool simt);
    std::vector<float> words;  ///< World::triangles that they were made from
    Buffer<float> triangles;
    Buffer<uint32_t> nodes;
    QuantisedTree quantised;
    Buffer<float> leaves;
    uint32_t root = W_NONE;
  };
  std::shared_ptr<const Surfaces> surfaces_;
  Buffer<WSphere> spheres_;
  uint32_t sphere_count_ = 0;
  Buffer<WSurfaceMaterial> surface_materials_;
  Buffer<WLight> lights_;
  uint32_t light_count_ = 0;
  bool samples_lights_ = false;
  Buffer<float> light_cdf_, light_triangles_;
  Buffer<int32_t> light_triangle_index_;
  WEnvironment environment_{};
  Buffer<w_float4> env_texels_;
  Buffer<float> env_cdf_;
  Buffer<uint32_t> events_;
};

}  // namespace wale
