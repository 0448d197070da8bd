#include "host/commands.h"

#include <fmt/format.h>

#include <cstdio>

#include "geom/error.h"
#include "host/accuracy.h"
#include "host/atomic_file.h"
#include "host/compare.h"
#include "host/export_curves.h"
#include "host/materials.h"
#include "host/plan.h"
#include "host/progress.h"
#include "host/report.h"
#include "host/stop.h"

namespace wale {
namespace {

World world_of(const Scene& scene, const Loaders& loaders, bool quiet) {
  Progress bar("knit", quiet);
  World world = build_world(scene, loaders, [&](const std::string& step, double fraction) {
    if (step == "knit") bar.update(fraction);
  });
  bar.finish();
  return world;
}

void require_json_path(const std::filesystem::path& file) {
  if (!file.empty() && file != "-") require_writable_path(file);
}

void deliver(const std::filesystem::path& json_file, const std::string& json, const std::string& text) {
  if (json_file == "-")
    fmt::print("{}", json);
  else if (!json_file.empty())
    write_text_file(json_file, json);
  if (json_file != "-") fmt::print("{}", text);
}

std::vector<TextileMeasures> measures_of(const Scene& scene, const World& world) {
  std::vector<TextileMeasures> out;
  for (size_t i = 0; i < world.fabrics.size(); ++i) {
    const FabricScene& fabric = scene.fabrics[i];
    const PlyAppearance& yarn = scene.materials.at(size_t(fabric.material)).yarn;
    out.push_back(measure_textile(world.fabrics[i], load_pattern(fabric.pattern), fabric.spec,
                                  {fibre_density(yarn), fibre_recipe(yarn).packing}));
  }
  return out;
}

}  // namespace

void apply_size(const std::string& size, FilmScene& film) {
  int w = 0, h = 0, end = 0;
  if (std::sscanf(size.c_str(), "%dx%d%n", &w, &h, &end) != 2 || size_t(end) != size.size() || w < 1 || h < 1 ||
      w > 65536 || h > 65536)
    user_error("--size {}: expected WIDTHxHEIGHT, each 1 to 65536, for example 768x768", size);
  film.width = w;
  film.height = h;
}

std::vector<std::string> overrides_of(const SceneArgs& args) {
  std::vector<std::string> overrides;
  if (!args.preset.empty()) overrides = accuracy_preset(args.preset).overrides();
  overrides.insert(overrides.end(), args.set.begin(), args.set.end());
  return overrides;
}

Scene read_scene(const SceneArgs& args) {
  Scene scene = read_scene(args.scene, overrides_of(args));
  scene.accuracy_preset = args.preset;
  return scene;
}

int run_build(const SceneArgs& args, const std::filesystem::path& json, const Loaders& loaders) {
  require_json_path(json);
  const Scene scene = read_scene(args);
  const World world = world_of(scene, loaders, args.quiet);
  const std::vector<TextileMeasures> textile = measures_of(scene, world);
  deliver(json, build_report_json(world, textile), build_report_text(world, textile));
  return 0;
}

int run_plan(const SceneArgs& args, const std::filesystem::path& json, const Loaders& loaders) {
  require_json_path(json);
  const Scene scene = read_scene(args);
  const Device device = Device::open(one_device_number(args.device));
  const World world = world_of(scene, loaders, args.quiet);
  const SceneDevice on_device(device, world);
  const Plan plan = plan_render(device, scene, world, on_device, args.also);
  deliver(json, plan_json(plan), plan_text(plan));
  return 0;
}

int run_export(const SceneArgs& args, const std::filesystem::path& output, const Loaders& loaders) {
  require_export_path(output);
  Scene scene = read_scene(args);
  for (FabricScene& fabric : scene.fabrics) {
    if (fabric.spec.lattice > 0 || fabric.spec.storage == Storage::procedural)
      user_error(
          "export: fabric \"{}\" is held as a lattice, which is not written; give \"storage\": \"stored\" and no "
          "\"lattice\"",
          fabric.spec.name);
    fabric.spec.storage = Storage::stored;
  }
  const Device device = Device::open(one_device_number(args.device));
  const World world = world_of(scene, loaders, args.quiet);
  const std::vector<float> points = FabricWarp(device, fabric_inputs(world), world.origin).points().read(device);
  std::vector<ExportCurve> curves;
  size_t first = 0;  // vertices of the fabrics follow one another
  for (const auto& fabric : world.fabrics) {
    for (const auto& run : fabric.runs)
      for (uint32_t curve_number = 0; curve_number < run.plies; ++curve_number) {
        ExportCurve curve;
        curve.radius = run.radius;
        const uint32_t skip = run.ghost_ends ? 1 : 0;
        for (uint32_t k = skip; k + skip < run.count; ++k) {
          const float* v = &points[(first + run.first_vertex + size_t(curve_number) * run.count + k) * 3];
          curve.points.push_back(
              {float(v[0] + world.origin.x), float(v[1] + world.origin.y), float(v[2] + world.origin.z)});
        }
        curves.push_back(std::move(curve));
      }
    first += fabric.anchors.size();
  }
  export_curves(curves, output);
  return 0;
}

int run_compare(const std::filesystem::path& a, const std::filesystem::path& b, double max_rmse) {
  const CompareReport report = compare_images(read_image(a), read_image(b), a.string(), b.string());
  fmt::print("{}", report.text());
  if (max_rmse >= 0 && !(report.rmse <= max_rmse))
    user_error("compare: RMSE {:.6g} is above --max-rmse {:.6g}", report.rmse, max_rmse);
  return 0;
}

int run_devices() {
  const auto devices = Device::list();
  if (devices.empty()) Device::open();  // says what to install
  for (size_t i = 0; i < devices.size(); ++i) {
    const auto& d = devices[i];
    fmt::print(
        "{}: {}\n   {} {}, {}\n   {} compute units, {:.1f} GiB, at most {:.1f} GiB in one buffer, fp64 {}\n"
        "   {}, {} paths in flight, work-groups of {}\n",
        i, d.name, d.platform, d.driver, d.version, d.compute_units, double(d.global_bytes) / (1u << 30),
        double(d.max_alloc_bytes) / (1u << 30), d.fp64 ? "yes" : "no",
        d.traversal == Traversal::simt ? "one ray per work-item" : fmt::format("vectors of {} lanes", d.lanes), d.pool,
        d.local_size);
  }
  return 0;
}

int run_schema() {
  fmt::print("{}", scene_schema());
  return 0;
}

}  // namespace wale
