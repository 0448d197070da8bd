#include "host/features.h"

#include <fmt/format.h>

#include "geom/error.h"
#include "host/ply_colors.h"
#include "host/scene.h"
#include "host/world.h"

namespace wale {

namespace {

// Quantised nodes are gone down in scalar code only, whatever vectors the scene asks for.
void choose_traversal(Features& f, const IntegratorScene& integrator, const DeviceTraits& traits) {
  f.simt = quantised_tree(traits, f.local_stage);
  f.double_precision = integrator.precision == "double";
  f.lanes = f.simt || f.double_precision ? 1 : integrator.lanes ? integrator.lanes : int(traits.lanes);
}

Normals normals_of(const IntegratorScene& integrator) {
  return integrator.normals == "flat"     ? Normals::flat
         : integrator.normals == "linear" ? Normals::linear
                                          : Normals::rotation_minimising;
}

}  // namespace

std::string Features::options() const {
  std::string out = fmt::format("-DW_LANES={} -DW_LOCAL_STAGE={}", lanes, int(local_stage));
  const auto define = [&](bool used, const char* name) {
    if (used) out += fmt::format(" -D{}", name);
  };
  define(plies || fibres, "W_HAS_PLIES");
  define(fibres, "W_HAS_FIBRES");
  define(procedural, "W_HAS_PROCEDURAL");
  define(simt, "W_SIMT");
  define(triangles, "W_HAS_TRIANGLES");
  define(spheres, "W_HAS_SPHERES");
  define(environment, "W_HAS_ENVIRONMENT");
  define(lights, "W_HAS_LIGHTS");
  define(detail, "W_HAS_DETAIL");
  define(paper_lobes, "W_PAPER_LOBES");
  define(double_precision, "W_DOUBLE");
  if (relaxed_math) out += " -cl-fast-relaxed-math";
  define(aovs, "W_AOVS");
  define(ply_colors, "W_HAS_PLY_COLORS");
  return out;
}

bool quantised_tree(const DeviceTraits& traits, LocalStage stage) {
  return traits.traversal == Traversal::simt && stage == LocalStage::exact;
}

LocalStage local_stage(const IntegratorScene& integrator) {
  return integrator.local_stage == "exact"  ? LocalStage::exact
         : integrator.local_stage == "cell" ? LocalStage::cell
                                            : LocalStage::ring;
}

Joints joints(const IntegratorScene& integrator) {
  return integrator.joints == "open"      ? Joints::open
         : integrator.joints == "capsule" ? Joints::capsule
                                          : Joints::mitre;
}

// Told before anything is compiled.
static void require_precision(const Features& f, const DeviceTraits& traits) {
  if (f.double_precision && !traits.fp64)
    user_error("integrator.precision: {} has no double precision (cl_khr_fp64); use \"float\"", traits.name);
}

Features analyse(const World& world, const IntegratorScene& integrator, bool aovs, const DeviceTraits& traits) {
  Features f;
  for (const auto& fabric : world.fabrics) {
    f.plies |= fabric.report.plies > 0;
    f.fibres |= fabric.report.fibres > 0;
    const bool lattice = !fabric.lattice.empty();
    f.mesh_warp |= !lattice && !fabric.anchors.empty();
    f.stored_lattice |= lattice && !fabric.procedural;
    f.procedural |= fabric.procedural;
  }
  f.triangles = world.triangle_count() > 0;
  f.spheres = !world.spheres.empty();
  f.environment = world.environment.radiance.w != 0;
  f.lights = !world.lights.lights.empty() && integrator.light_sampling != "bsdf";
  f.detail = f.plies && world.fibres.any();
  f.paper_lobes = f.plies && integrator.ply_lobes == "paper";
  f.relaxed_math = integrator.math == "relaxed";
  f.aovs = aovs;
  f.ply_colors = !world.ply_colors.empty();
  f.local_stage = local_stage(integrator);
  f.normals = normals_of(integrator);
  choose_traversal(f, integrator, traits);
  require_precision(f, traits);
  return f;
}

Features foresee(const Scene& scene, bool aovs, const DeviceTraits& traits) {
  Features f;
  for (const auto& fabric : scene.fabrics) {
    const bool fibres = fabric.spec.detail == Detail::fibres;
    const PlyAppearance& yarn = scene.materials.at(size_t(fabric.material)).yarn;
    f.plies |= !fibres;
    f.fibres |= fibres || fabric.spec.flyaways.any();
    f.detail |= fabric.spec.detail == Detail::maps || fabric.spec.detail == Detail::paper;
    f.ply_colors |= colors_vary(yarn, fabric.color_image);
    const bool procedural = fabric.spec.storage == Storage::procedural, lattice = fabric.spec.lattice > 0;
    f.mesh_warp |= !lattice && !procedural;
    f.stored_lattice |= lattice && !procedural;
    f.procedural |= procedural;
  }
  for (const auto& object : scene.objects) {
    f.spheres |= object.kind == ObjectScene::Kind::sphere;
    f.triangles |= object.kind != ObjectScene::Kind::sphere;
  }
  for (const auto& light : scene.lights) {
    if (light.file.empty() && light.radiance == Rgb{0, 0, 0}) continue;
    f.lights = true;
    f.environment |= light.kind == LightScene::Kind::environment;
    f.spheres |= light.kind == LightScene::Kind::sphere;
    f.triangles |= light.kind == LightScene::Kind::quad || light.kind == LightScene::Kind::mesh;
  }
  const IntegratorScene& integrator = scene.integrator;
  f.lights = f.lights && integrator.light_sampling != "bsdf";
  f.paper_lobes = f.plies && integrator.ply_lobes == "paper";
  f.relaxed_math = integrator.math == "relaxed";
  f.aovs = aovs;
  f.local_stage = local_stage(integrator);
  f.normals = normals_of(integrator);
  choose_traversal(f, integrator, traits);
  return f;
}

std::vector<Reason> explain(const World& world, const IntegratorScene& integrator, const Features& f) {
  const auto names = [](const auto& items, const auto& name) {
    std::string out;
    for (const auto& item : items) out += (out.empty() ? "" : ", ") + std::string(name(item));
    return out;
  };
  const std::string lights = names(world.light_names, [](const auto& n) { return n; });
  const auto with = [&](const auto& has) {
    std::vector<std::string> chosen;
    for (const auto& fabric : world.fabrics)
      if (has(fabric)) chosen.push_back(fabric.name);
    return names(chosen, [](const auto& n) { return n; });
  };
  const bool curves = f.plies || f.fibres;
  return {
      {"plies", f.plies,
       f.plies    ? "fabrics: " + with([](const Fabric& x) { return x.report.plies > 0; })
       : f.fibres ? "every fabric shows its fibres instead"
                  : "no fabric in the scene"},
      {"fibres", f.fibres,
       f.fibres ? "detail \"fibres\" or flyaways of " + with([](const Fabric& x) { return x.report.fibres > 0; })
                : "no fabric has detail \"fibres\" or flyaways"},
      {"procedural storage", f.procedural,
       f.procedural ? "fabrics: " + with([](const Fabric& x) { return x.procedural; })
                    : "no fabric has storage \"procedural\", or one that is large and regular enough"},
      {"triangles", f.triangles,
       f.triangles ? fmt::format("{} triangles of props and lights", world.triangle_count())
                   : "no mesh, ground or quad light"},
      {"spheres", f.spheres, f.spheres ? fmt::format("{} spheres", world.spheres.size()) : "no sphere"},
      {"environment", f.environment, f.environment ? "an environment light" : "no environment light"},
      {"light sampling", f.lights,
       f.lights                              ? "lights: " + lights
       : integrator.light_sampling == "bsdf" ? "integrator.light_sampling is \"bsdf\""
                                             : "no light to sample"},
      {"fibre detail", f.detail,
       f.detail  ? "fabrics.detail is \"maps\" or \"paper\""
       : f.plies ? "fabrics.detail is \"none\""
       : curves  ? "every fibre is a curve of its own"
                 : "no fabric in the scene"},
      {"Lambert ply lobes", f.paper_lobes, "integrator.ply_lobes is \"" + integrator.ply_lobes + "\""},
      {"double precision", f.double_precision, "integrator.precision is \"" + integrator.precision + "\""},
      {"relaxed arithmetic", f.relaxed_math, "integrator.math is \"" + integrator.math + "\""},
      {"feature images", f.aovs, f.aovs ? "an .exr is written" : "only .png is written"},
      {"varying colours", f.ply_colors,
       f.ply_colors ? "fabrics: " + names(world.colored_fabrics, [](const auto& n) { return n; })
                    : "no plies, stripes, heather or color_image"},
      {"local stage " + integrator.local_stage, curves, curves ? "integrator.local_stage" : "no fabric in the scene"},
      {"normals " + integrator.normals, curves, curves ? "integrator.normals" : "no fabric in the scene"},
      {"joints " + integrator.joints, curves, curves ? "integrator.joints" : "no fabric in the scene"},
      {fmt::format("{} lanes", f.lanes), true,
       f.simt               ? "one ray per work-item, down quantised nodes"
       : f.double_precision ? "integrator.precision is \"double\""
       : integrator.lanes ? "integrator.lanes"
                          : "width of the device's vectors"},
  };
}

}  // namespace wale
