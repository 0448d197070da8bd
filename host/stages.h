#pragma once
#include <string>
#include <vector>

#include "host/features.h"

namespace wale {

/// A stage of the wavefront: one kernel file, its kernels, and whether a scene's features ask for it.
struct Stage {
  std::string file;  ///< below kernels/
  std::vector<std::string> kernels;
  bool used = true;
  std::string because;
  double bytes_per_item = 0;       ///< of path state, lists and stored geometry that an item reads and writes
  double operations_per_item = 0;  ///< of floats; 0: not counted
  bool before_rays = false;        ///< runs once, on the scene's geometry; has no variants
  std::string program = {};        ///< file that includes this one and others like it, where they are compiled together
  bool can_wait = false;           ///< another stage does its work, as well but slower, until it is compiled
  size_t taken_at_once = 1;        ///< rays or hits that one work-item takes
};

/// What makes the scene's plies ready to be traced.
std::vector<Stage> geometry_stages(const Features& features);

/// All stages in the order of a bounce; those that are not used are neither compiled nor launched.
std::vector<Stage> wavefront_stages(const Features& features);

/// What is compiled at once.
struct StageProgram {
  std::string file;  ///< below kernels/
  std::vector<std::string> kernels;
  bool before_rays = false, can_wait = false;  ///< as Stage
  size_t taken_at_once = 1;
};

/// Most programs that one render compiles for a device: one of each stage. All that differs between two scenes of the
/// same structure is data, so that no stage is ever compiled a second time, whatever changes while a program runs.
constexpr size_t kMostPrograms = 15;

/// Programs of the stages that are used, in their order. `together`: a driver that compiles one kernel after the other
/// is spared reading the same headers again and again; others compile each stage on a thread of its own.
std::vector<StageProgram> programs_of(const std::vector<Stage>& stages, bool together);

}  // namespace wale
