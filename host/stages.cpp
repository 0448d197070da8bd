#include "host/stages.h"

#include <algorithm>

#include "shared/wale_types.h"

namespace wale {
namespace {

// Bytes of a stage's buffers per item, for its floor (host/stage_profile.h). What every item shares and caches hold
// (materials, lights, counts) is not counted, nor is the tree: bytes of a traversal depend on the ray and are counted
// by `wale bench`.
//
//   stage          an item is         reads                                       writes
//   generate       a path of a wave   -                                           list, mask, ray 3, weight, radiance
//   intersect      a ray              list, ray 3                                 hit, barycentrics, mask
//   compact        a slot of a list   twice list and mask                         list
//   miss           a path that left   list, ray direction, weight, radiance       mask, radiance
//   shade_ply      a hit              list, ray 3, hit, barycentrics, weight,     mask, ray 3, weight, shadow ray 3
//                                     leaf header, 4 points, 2 frames             and colour
//   shade_fibre    a hit              the same                                    the same
//   shade_surface  a hit              list, ray 3, hit, barycentrics, weight,     mask, ray 3, weight, radiance,
//                                     radiance, triangle                          shadow ray 3 and colour
//   connect        a shadow ray       list, shadow ray 3 and colour, radiance     radiance
//   accumulate     a path             radiance, pixel sum                         pixel sum
//   accumulate_aov a path             4 features, 4 pixel sums                    4 pixel sums
constexpr double kWord = 4, kVec = 16, kRay = 3 * kVec, kUv = 8;
constexpr double kShadowRay = kRay + kVec;
constexpr double kLeafPart = W_LEAF_HEADER * kWord + 4 * 3 * kWord + 2 * W_FRAME_WORDS * kWord;
constexpr double kTriangle = 20 * kWord;

// Additions and multiplications of one hit with one light sample, as `oclgrind --inst-counts` counted them of one hit
// an item (a dot product as five, a fused multiply-add as two), and 20 for each of its 24 exponentials, logarithms and
// angles (kernels/shared/elementary.clh).
constexpr double kShadePlyOperations = 1000 + 24 * 20;

}  // namespace

std::vector<Stage> geometry_stages(const Features& f) {
  return {{.file = "warp.cl",
           .kernels = {"warp_points", "warp_normals"},
           .used = f.mesh_warp,
           .because = "plies on the base mesh",
           .before_rays = true},
          {.file = "lattice_vertices.cl",
           .kernels = {"lattice_points", "lattice_normals"},
           .used = f.stored_lattice,
           .because = "plies of a lattice, stored",
           .before_rays = true},
          {.file = "lattice_boxes.cl",
           .kernels = {"lattice_boxes"},
           .used = f.procedural,
           .because = "bounds of procedural leaves",
           .before_rays = true},
          {.file = "pack.cl",
           .kernels = f.quantised_vertices ? std::vector<std::string>{"measure_leaves", "pack_leaves", "place_leaves"}
                                           : std::vector<std::string>{"pack_leaves", "place_leaves"},
           .used = f.mesh_warp || f.stored_lattice,
           .because = "leaves and bounds",
           .before_rays = true}};
}

std::vector<Stage> wavefront_stages(const Features& f) {
  const bool surfaces = f.triangles || f.spheres;
  const double shadow = f.lights ? kShadowRay : 0, features = f.four_vectors() ? 4 * kVec : 0;
  const double shade = kWord + 2 * kRay + 2 * kVec + kVec + kUv + kWord + shadow;
  const std::string paths = "stages/paths.cl", trace = "stages/trace.cl";
  return {
      {.file = "stages/generate.cl",
       .kernels = {"generate"},
       .because = "camera rays",
       .bytes_per_item = 2 * kWord + kRay + 2 * kVec,
       .program = paths},
      {.file = "stages/intersect.cl",
       .kernels = {"intersect"},
       .because = "nearest hits",
       .bytes_per_item = kWord + kRay + kVec + kUv + kWord,
       .program = trace},
      {.file = "stages/intersect_packets.cl",
       .kernels = {"intersect_packets"},
       .used = f.packets(),
       .because =
           f.packets() ? "nearest hits of camera rays, many at once" : "vectors or local stage do not suit packets",
       .bytes_per_item = kWord + kRay + kVec + kUv + kWord,
       .can_wait = true,
       .taken_at_once = size_t(f.lanes)},
      {.file = "stages/compact.cl",
       .kernels = {"compact_count", "compact_scan", "compact_scatter"},
       .because = "queues",
       .bytes_per_item = 5 * kWord,
       .program = paths},
      {.file = "stages/miss.cl",
       .kernels = {"miss"},
       .because = f.environment ? "paths that leave gather the environment" : "paths that leave end",
       .bytes_per_item = 2 * kWord + (f.environment ? 4 * kVec : 0),
       .program = paths},
      {.file = "stages/shade_ply.cl",
       .kernels = {"shade_ply"},
       .used = f.plies,
       .because = f.plies ? "plies" : "no ply is shown",
       .bytes_per_item = shade + kLeafPart,
       .operations_per_item = kShadePlyOperations,
       .taken_at_once = size_t(f.lanes)},
      {"stages/shade_fibre.cl",
       {"shade_fibre"},
       f.fibres,
       f.fibres ? "single fibres" : "no fibre is explicit",
       shade + kLeafPart},
      {"stages/shade_surface.cl",
       {"shade_surface"},
       surfaces,
       surfaces ? "props, ground or visible lights" : "no props",
       shade + 2 * kVec + kTriangle},
      {.file = "stages/connect.cl",
       .kernels = {"connect"},
       .used = f.lights,
       .because = f.lights ? "shadow rays" : "nothing is sampled",
       .bytes_per_item = kWord + kShadowRay + 2 * kVec,
       .program = trace},
      {.file = "stages/accumulate.cl",
       .kernels = {"accumulate"},
       .because = "pixel sums",
       .bytes_per_item = 3 * kVec,
       .program = paths},
      {"stages/accumulate_aov.cl",
       {"accumulate_aov"},
       f.four_vectors(),
       f.gradients ? "derivative images"
       : f.aovs    ? "feature images"
                   : "no .exr is written",
       3 * features},
  };
}

std::vector<StageProgram> programs_of(const std::vector<Stage>& stages, bool together) {
  std::vector<StageProgram> programs;
  for (const Stage& stage : stages) {
    if (!stage.used) continue;
    const std::string& file = together && !stage.program.empty() ? stage.program : stage.file;
    auto program = std::find_if(programs.begin(), programs.end(), [&](const auto& p) { return p.file == file; });
    if (program == programs.end())
      program = programs.insert(program, {file, {}, stage.before_rays, stage.can_wait, stage.taken_at_once});
    program->kernels.insert(program->kernels.end(), stage.kernels.begin(), stage.kernels.end());
  }
  return programs;
}

}  // namespace wale
