#include "host/stages.h"

namespace wale {

std::vector<Stage> wavefront_stages(const Features& f) {
  const bool surfaces = f.triangles || f.spheres;
  return {
      {"stages/generate.cl", {"generate"}, true, "camera rays"},
      {"stages/intersect.cl", {"intersect"}, true, "nearest hits"},
      {"stages/intersect_packets.cl",
       {"intersect_packets"},
       f.packets(),
       f.packets() ? "nearest hits of camera rays, many at once" : "vectors or local stage do not suit packets"},
      {"stages/compact.cl", {"compact_count", "compact_scan", "compact_scatter"}, true, "queues"},
      {"stages/miss.cl",
       {"miss"},
       true,
       f.environment ? "paths that leave gather the environment" : "paths that leave end"},
      {"stages/shade_ply.cl", {"shade_ply"}, f.plies, f.plies ? "plies" : "no ply is shown"},
      {"stages/shade_fibre.cl", {"shade_fibre"}, f.fibres, f.fibres ? "single fibres" : "no fibre is explicit"},
      {"stages/shade_surface.cl",
       {"shade_surface"},
       surfaces,
       surfaces ? "props, ground or visible lights" : "no props"},
      {"stages/connect.cl", {"connect"}, f.lights, f.lights ? "shadow rays" : "nothing is sampled"},
      {"stages/accumulate.cl", {"accumulate"}, true, "pixel sums"},
      {"stages/accumulate_aov.cl", {"accumulate_aov"}, f.aovs, f.aovs ? "feature images" : "no .exr is written"},
  };
}

}  // namespace wale
