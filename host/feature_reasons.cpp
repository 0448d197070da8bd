// Why each feature is there or not: the objects and keys that ask for it.
#include <fmt/format.h>

#include "host/features.h"
#include "host/scene.h"
#include "host/world.h"

namespace wale {
namespace {

std::string list(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : ", ") + name;
  return out;
}

/// Names of the fabrics, by number, that a predicate holds for.
template <typename Has>
std::string fabrics(const World& world, const Has& has) {
  std::vector<std::string> chosen;
  for (size_t i = 0; i < world.fabrics.size(); ++i)
    if (has(i)) chosen.push_back(world.fabrics[i].name);
  return list(chosen);
}

std::string environment_name(const World& world) {
  return world.environment.light >= 0 ? world.light_names[size_t(world.environment.light)] : "";
}

std::string why_fibres(const World& world) {
  const std::string explicit_ones =
      fabrics(world, [&](size_t i) { return world.fabrics[i].report.fibres > world.fabrics[i].report.flyaways; });
  const std::string loose = fabrics(world, [&](size_t i) { return world.fabrics[i].report.flyaways > 0; });
  std::string out = explicit_ones.empty() ? "" : "fabrics.detail \"fibres\" of " + explicit_ones;
  if (!loose.empty()) out += (out.empty() ? "" : "; ") + ("fabrics.flyaways of " + loose);
  return out;
}

std::string why_detail(const World& world) {
  return "fabrics.detail \"maps\" or \"paper\" of " + fabrics(world, [&](size_t i) {
           return world.fibres.details[world.fabric_material[i]].level != W_DETAIL_NONE;
         });
}

}  // namespace

std::vector<Reason> explain(const World& world, const IntegratorScene& integrator, const Features& f) {
  const bool curves = f.plies || f.fibres;
  const std::string no_fabric = "no fabric in the scene";
  return {
      {"plies", f.plies,
       f.plies    ? "fabrics: " + fabrics(world, [&](size_t i) { return world.fabrics[i].report.plies > 0; })
       : f.fibres ? "every fabric shows its fibres instead"
                  : no_fabric},
      {"fibres", f.fibres, f.fibres ? why_fibres(world) : "no fabric has detail \"fibres\" or flyaways"},
      {"procedural storage", f.procedural,
       f.procedural ? "fabrics: " + fabrics(world, [&](size_t i) { return world.fabrics[i].procedural; })
                    : "no fabric has storage \"procedural\", or one that is large and regular enough"},
      {"triangles", f.triangles,
       f.triangles ? fmt::format("{} triangles of {}", world.triangle_count(), list(world.triangle_names))
                   : "no mesh, ground or quad light"},
      {"spheres", f.spheres,
       f.spheres ? fmt::format("{} spheres: {}", world.spheres.size(), list(world.sphere_names)) : "no sphere"},
      {"environment", f.environment,
       f.environment ? "an environment light: " + environment_name(world) : "no environment light"},
      {"light sampling", f.lights,
       f.lights                              ? "lights: " + list(world.light_names)
       : integrator.light_sampling == "bsdf" ? "integrator.light_sampling is \"bsdf\""
                                             : "no light to sample"},
      {"fibre detail", f.detail,
       f.detail  ? why_detail(world)
       : f.plies ? "fabrics.detail is \"none\""
       : curves  ? "every fibre is a curve of its own"
                 : no_fabric},
      {"Lambert ply lobes", f.paper_lobes, "integrator.ply_lobes is \"" + integrator.ply_lobes + "\""},
      {"quantised vertices", f.quantised_vertices,
       curves ? "integrator.vertices is \"" + integrator.vertices + "\"" : no_fabric},
      {"double precision", f.double_precision, "integrator.precision is \"" + integrator.precision + "\""},
      {"relaxed arithmetic", f.relaxed_math, "integrator.math is \"" + integrator.math + "\""},
      {"feature images", f.aovs, f.aovs ? "an .exr is written" : "only .png is written"},
      {"varying colours", f.ply_colors,
       f.ply_colors ? "fabrics: " + list(world.colored_fabrics) : "no plies, stripes, heather or color_image"},
      {"local stage " + integrator.local_stage, curves, curves ? "integrator.local_stage" : no_fabric},
      {"normals " + integrator.normals, curves, curves ? "integrator.normals" : no_fabric},
      {"joints " + integrator.joints, curves, curves ? "integrator.joints" : no_fabric},
      {fmt::format("{} lanes", f.lanes), true,
       f.simt               ? "one ray per work-item, down quantised nodes"
       : f.double_precision ? "integrator.precision is \"double\""
       : integrator.lanes   ? "integrator.lanes"
                            : "width of the device's vectors"},
  };
}

}  // namespace wale
