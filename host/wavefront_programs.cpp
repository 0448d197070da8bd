// The programs of a wavefront, and what their kernels are given of the scene.
#include <algorithm>
#include <chrono>
#include <future>

#include "geom/error.h"
#include "host/kernel_args.h"
#include "host/program.h"
#include "host/stages.h"
#include "host/wavefront.h"

namespace wale {
namespace {

/// Width of a pixel on what the camera sees: x metres, and y metres more per metre of distance.
cl_float2 pixel_width(const WCamera& camera) {
  const float film = 2 * camera.half_height / float(camera.height);
  return camera.kind == 1 ? cl_float2{{film, 0}} : cl_float2{{0, film}};
}

}  // namespace

cl_uint Wavefront::bind_path(cl::Kernel& k, cl_uint first) const {
  set_args(k, first, ray_o_.cl(), ray_l_.cl(), ray_d_.cl(), weight_.cl(), hit_.cl(), hit_uv_.cl(), radiance_.cl(),
           shadow_o_.cl(), shadow_l_.cl(), shadow_d_.cl(), shadow_c_.cl(), mask_.cl(), tiles_.cl());
  if (!features_.gradients) return first + 13;
  set_args(k, first + 13, score_.cl(), shadow_gradient_.cl(), aov_.cl());
  return first + 16;
}

void Wavefront::bind_intersect(const char* name) {
  scene_->bind_scene(kernel(name), bind_path(kernel(name), 1), features_.procedural);
}

void Wavefront::take_packets() {
  if (!waiting_ || is_being_compiled(device_, waiting_->file, options_, kernel_dir_)) return;
  const cl::Program program = build_program(device_, waiting_->file, options_, kernel_dir_);
  kernels_["intersect_packets"] = cl::Kernel(program, "intersect_packets");
  bind_intersect("intersect_packets");
  waiting_.reset();
}

void Wavefront::build_programs() {
  options_ = features_.options() + scene_->options();
  auto programs = programs_of(wavefront_stages(features_), device_.traits().compiles_at_launch);
  for (const StageProgram& program : programs)
    for (const auto& name : program.kernels) taken_at_once_[name] = program.taken_at_once;
  const auto wait = std::find_if(programs.begin(), programs.end(), [&](const StageProgram& program) {
    return program.can_wait && is_being_compiled(device_, program.file, options_, kernel_dir_);
  });
  if (wait != programs.end()) {
    waiting_ = *wait;
    programs.erase(wait);
  }

  // One thread per program, where the driver bears it: compilation is the whole of the start-up time.
  const auto policy = device_.traits().parallel_builds ? std::launch::async : std::launch::deferred;
  using Clock = std::chrono::steady_clock;
  std::vector<std::future<std::pair<cl::Program, double>>> builds;
  for (const auto& one : programs)
    builds.push_back(std::async(policy, [&, file = one.file] {
      const auto start = Clock::now();
      cl::Program program = build_program(device_, file, options_, kernel_dir_);
      return std::pair(program, std::chrono::duration<double>(Clock::now() - start).count());
    }));
  for (size_t i = 0; i < programs.size(); ++i) {
    auto [program, seconds] = builds[i].get();
    counts_.program_seconds[programs[i].file] = seconds;
    for (const auto& name : programs[i].kernels) kernels_[name] = cl::Kernel(program, name.c_str());
  }

  bind();
}

bool Wavefront::serves(const SceneDevice& scene, const Features& features) const {
  return features.options() + scene.options() == options_;
}

void Wavefront::rebind(const SceneDevice& scene, const Features& features, const WCamera& camera, bool keep_film) {
  if (!serves(scene, features) || camera.width != camera_.width || camera.height != camera_.height)
    bug("wavefront: bound to a scene or a picture that it was not made for");
  harvest_events();
  scene_ = &scene;
  features_ = features;
  camera_ = camera;
  if (!keep_film) film_.clear(device_);
  bind();
}

void Wavefront::leave_scene() {
  const auto events = scene_->read_events();
  for (size_t i = 0; i < counts_.events.size(); ++i) counts_.events[i] += events[i];
}

void Wavefront::bind() {
  const PlyTree& tree = scene_->fabric().tree;
  if (!tree.leaf_offset.empty() && tree.form.quantised() != features_.quantised_vertices)
    bug("wavefront: kernels and leaves differ in how vertices are kept");
  // `first` is the index behind WFrame, which every launch sets anew.
  const auto path = [&](cl::Kernel& k, cl_uint first) { return bind_path(k, first); };
  auto& generate = kernel("generate");
  generate.setArg(1, camera_);
  set_args(generate, path(generate, 2), spare_list_.cl(), queue_counts_.cl());
  for (const char* name : {"intersect", "intersect_packets"})
    if (kernels_.contains(name)) bind_intersect(name);
  auto& miss = kernel("miss");
  cl_uint next = scene_->bind_lights(miss, path(miss, 1));
  set_args(miss, next, aov_.cl(), miss_list_.cl(), queue_counts_.cl(), kHits + 2);
  if (kernels_.contains("shade_ply")) {
    auto& k = kernel("shade_ply");
    next = scene_->bind_lights(k, scene_->bind_scene(k, path(k, 1), features_.procedural));
    set_args(k, next, scene_->frames(), uint32_t(features_.normals), scene_->ply_materials());
    next += 3;
    if (features_.detail) {
      set_args(k, next, scene_->fibre_details(), scene_->fibre_offsets(), scene_->fibre_candidates());
      set_args(k, next + 3, pixel_width(camera_));
      next += 4;
    }
    if (features_.ply_colors) next = scene_->bind_ply_colors(k, next);
    set_args(k, next, aov_.cl(), ply_list_.cl(), queue_counts_.cl(), kHits);
  }
  if (kernels_.contains("shade_fibre")) {
    auto& k = kernel("shade_fibre");
    next = scene_->bind_lights(k, scene_->bind_scene(k, path(k, 1), features_.procedural));
    set_args(k, next, scene_->frames(), uint32_t(features_.normals), scene_->fibre_materials());
    next += 3;
    if (features_.ply_colors) next = scene_->bind_ply_colors(k, next);
    set_args(k, next, aov_.cl(), fibre_list_.cl(), queue_counts_.cl(), kHits + 3);
  }
  if (kernels_.contains("shade_surface")) {
    auto& k = kernel("shade_surface");
    next = scene_->bind_lights(k, path(k, 1));
    set_args(k, next, scene_->triangles(), scene_->spheres(), scene_->surface_materials(), aov_.cl(),
             surface_list_.cl(), queue_counts_.cl(), kHits + 1);
  }
  if (features_.lights) {
    auto& k = kernel("connect");
    next = scene_->bind_scene(k, path(k, 1), features_.procedural);
    set_args(k, next, shadow_list_.cl(), queue_counts_.cl());
  }
  set_args(kernel("accumulate"), 1, camera_, tiles_.cl());
  if (features_.four_vectors()) {
    set_args(kernel("accumulate_aov"), 1, camera_, tiles_.cl());
    kernel("accumulate_aov").setArg(8, shift_);
  }
}

void Wavefront::shift_positions(const dvec3& shift) {
  shift_ = {{float(shift.x), float(shift.y), float(shift.z), 0}};
  if (features_.four_vectors()) kernel("accumulate_aov").setArg(8, shift_);
}

}  // namespace wale
