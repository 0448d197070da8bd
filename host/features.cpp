#include "host/features.h"

#include <fmt/format.h>

#include "host/scene.h"
#include "host/world.h"

namespace wale {

std::string Features::options() const {
  std::string out = fmt::format("-DW_LANES={} -DW_LOCAL_STAGE={}", lanes, int(local_stage));
  const auto define = [&](bool used, const char* name) {
    if (used) out += fmt::format(" -D{}", name);
  };
  define(plies, "W_HAS_PLIES");
  define(triangles, "W_HAS_TRIANGLES");
  define(spheres, "W_HAS_SPHERES");
  define(environment, "W_HAS_ENVIRONMENT");
  define(lights, "W_HAS_LIGHTS");
  define(aovs, "W_AOVS");
  define(ply_colors, "W_HAS_PLY_COLORS");
  return out;
}

LocalStage local_stage(const IntegratorScene& integrator) {
  return integrator.local_stage == "exact"  ? LocalStage::exact
         : integrator.local_stage == "cell" ? LocalStage::cell
                                            : LocalStage::ring;
}

Features analyse(const World& world, const IntegratorScene& integrator, bool aovs, int device_lanes) {
  Features f;
  for (const auto& fabric : world.fabrics) f.plies |= !fabric.patches.empty();
  f.triangles = world.triangle_count() > 0;
  f.spheres = !world.spheres.empty();
  f.environment = world.environment.radiance.w != 0;
  f.lights = !world.lights.lights.empty() && integrator.light_sampling != "bsdf";
  f.aovs = aovs;
  f.ply_colors = !world.ply_colors.empty();
  f.local_stage = local_stage(integrator);
  f.lanes = integrator.lanes ? integrator.lanes : device_lanes;
  return f;
}

std::vector<Reason> explain(const World& world, const IntegratorScene& integrator, const Features& f) {
  const auto names = [](const auto& items, const auto& name) {
    std::string out;
    for (const auto& item : items) out += (out.empty() ? "" : ", ") + std::string(name(item));
    return out;
  };
  const std::string lights = names(world.light_names, [](const auto& n) { return n; });
  return {
      {"plies", f.plies,
       f.plies ? "fabrics: " + names(world.fabrics, [](const auto& x) { return x.name; }) : "no fabric in the scene"},
      {"triangles", f.triangles,
       f.triangles ? fmt::format("{} triangles of props and lights", world.triangle_count())
                   : "no mesh, ground or quad light"},
      {"spheres", f.spheres, f.spheres ? fmt::format("{} spheres", world.spheres.size()) : "no sphere"},
      {"environment", f.environment, f.environment ? "an environment light" : "no environment light"},
      {"light sampling", f.lights,
       f.lights                              ? "lights: " + lights
       : integrator.light_sampling == "bsdf" ? "integrator.light_sampling is \"bsdf\""
                                             : "no light to sample"},
      {"feature images", f.aovs, f.aovs ? "an .exr is written" : "only .png is written"},
      {"varying colours", f.ply_colors,
       f.ply_colors ? "fabrics: " + names(world.colored_fabrics, [](const auto& n) { return n; })
                    : "no plies, stripes, heather or color_image"},
      {"local stage " + integrator.local_stage, f.plies, f.plies ? "integrator.local_stage" : "no fabric in the scene"},
      {fmt::format("{} lanes", f.lanes), true, integrator.lanes ? "integrator.lanes" : "width of the device's vectors"},
  };
}

}  // namespace wale
