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

// Definitions that no curve is read with would make other programs for nothing.
bool keeps_quantised(const Features& f, const IntegratorScene& integrator) {
  return (f.plies || f.fibres) && leaf_form(integrator).quantised();
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
  define(quantised_vertices, "W_QUANTISED_VERTICES");
  define(double_precision, "W_DOUBLE");
  if (relaxed_math) out += " -cl-fast-relaxed-math";
  define(aovs, "W_AOVS");
  define(gradients, "W_GRADIENTS");
  define(ply_colors, "W_HAS_PLY_COLORS");
  return out;
}

Features Features::with(const Features& others) const {
  Features all = *this;
  all.plies |= others.plies;
  all.fibres |= others.fibres;
  all.triangles |= others.triangles;
  all.spheres |= others.spheres;
  all.environment |= others.environment;
  all.lights |= others.lights;
  all.detail |= others.detail;
  all.aovs |= others.aovs;
  all.gradients |= others.gradients;
  all.ply_colors |= others.ply_colors;
  // The other local stages need cells, which lattices do not have.
  all.procedural |= others.procedural && local_stage == LocalStage::exact;
  return all;
}

Features Features::everything() {
  Features all;
  all.plies = all.fibres = all.triangles = all.spheres = all.environment = all.lights = true;
  all.detail = all.aovs = all.ply_colors = all.procedural = true;
  return all;
}

bool quantised_tree(const DeviceTraits& traits, LocalStage stage) {
  return traits.traversal == Traversal::simt && stage == LocalStage::exact;
}

LocalStage local_stage(const IntegratorScene& integrator) {
  return integrator.local_stage == "exact"  ? LocalStage::exact
         : integrator.local_stage == "cell" ? LocalStage::cell
                                            : LocalStage::ring;
}

LeafForm leaf_form(const IntegratorScene& integrator) {
  const Joints joints = integrator.joints == "open"      ? Joints::open
                        : integrator.joints == "capsule" ? Joints::capsule
                                                         : Joints::mitre;
  return {joints, integrator.vertices == "quantised" ? Vertices::quantised : Vertices::full};
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
  f.quantised_vertices = keeps_quantised(f, integrator);
  f.aovs = aovs;
  f.ply_colors = !world.ply_colors.empty();
  f.local_stage = local_stage(integrator);
  f.normals = normals_of(integrator);
  choose_traversal(f, integrator, traits);
  require_precision(f, traits);
  return f;
}

namespace {
// What cannot be read is said where it is knitted.
std::vector<Rgb> foreseen_colors(const FabricScene& fabric) {
  try {
    return yarn_colors(fabric, fabric.palette ? Pattern() : load_pattern(fabric.pattern));
  } catch (const Error&) {
    return {};
  }
}
}  // namespace

Features foresee(const Scene& scene, bool aovs, const DeviceTraits& traits) {
  Features f;
  for (const auto& fabric : scene.fabrics) {
    const bool fibres = fabric.spec.detail == Detail::fibres;
    const PlyAppearance& yarn = scene.materials.at(size_t(fabric.material)).yarn;
    f.plies |= !fibres;
    f.fibres |= fibres || fabric.spec.flyaways.any();
    f.detail |= fabric.spec.detail == Detail::maps || fabric.spec.detail == Detail::paper;
    f.ply_colors |= colors_vary(yarn, fabric.color_image, foreseen_colors(fabric));
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
    f.lights = true;
    f.environment |= light.kind == LightScene::Kind::environment;
    f.spheres |= light.kind == LightScene::Kind::sphere;
    f.triangles |= light.kind == LightScene::Kind::quad || light.kind == LightScene::Kind::mesh;
  }
  const IntegratorScene& integrator = scene.integrator;
  f.lights = f.lights && integrator.light_sampling != "bsdf";
  f.paper_lobes = f.plies && integrator.ply_lobes == "paper";
  f.relaxed_math = integrator.math == "relaxed";
  f.quantised_vertices = keeps_quantised(f, integrator);
  f.aovs = aovs;
  f.local_stage = local_stage(integrator);
  f.normals = normals_of(integrator);
  choose_traversal(f, integrator, traits);
  return f;
}

}  // namespace wale
