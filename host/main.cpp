#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "geom/base_mesh.h"
#include "geom/error.h"
#include "host/commands.h"
#include "host/device.h"

namespace {

using wale::RenderArgs;
using wale::SceneArgs;

void add_scene_options(CLI::App& command, SceneArgs& args) {
  command.add_option("SCENE", args.scene, "scene file")->required();
  command.add_option("--set", args.set, "change a key of the scene: key.path=value (repeatable)")->take_all();
  command.add_option("--device", args.device, "number of the OpenCL device, see `wale devices`");
  command.add_option("--kernel-dir", args.kernel_dir, "read kernels from this folder instead of the built-in ones");
  command.add_flag("--quiet", args.quiet, "no progress");
}

int run(int argc, char** argv) {
  const wale::Loaders loaders{[](const auto& file) { return wale::read_mesh(file); },
                              [](const auto& file) { return wale::read_image(file, true); }};
  CLI::App app{"Wale: a portable OpenCL path tracer for knitted fabric at ply level"};
  app.require_subcommand(1);
  int status = 0;

  RenderArgs render;
  auto* c = app.add_subcommand("render", "render a scene to images (.exr with features, .png)");
  add_scene_options(*c, render);
  c->add_option("-o,--output", render.outputs, "image to write (repeatable)")->required();
  c->add_option("--spp", render.spp, "samples per pixel")->check(CLI::Range(1, 1 << 24));
  c->add_option("--seconds", render.seconds, "stop after this time")->check(CLI::PositiveNumber);
  c->add_option("--size", render.size, "WIDTHxHEIGHT");
  c->add_option("--stats", render.stats, "write what was done as JSON");
  c->callback([&] { status = wale::run_render(render, loaders); });

  SceneArgs scene;
  std::filesystem::path json, output, image_a, image_b;
  double max_rmse = -1;
  c = app.add_subcommand("build", "knit a scene and report yarns, plies, segments, bytes, stretch");
  add_scene_options(*c, scene);
  c->add_option("--json", json, "write the report as JSON (- for the terminal)");
  c->callback([&] { status = wale::run_build(scene, json, loaders); });
  c = app.add_subcommand("plan", "say what will be simulated and why");
  add_scene_options(*c, scene);
  c->add_option("--json", json, "write the plan as JSON (- for the terminal)");
  c->callback([&] { status = wale::run_plan(scene, json, loaders); });
  c = app.add_subcommand("export", "write the ply curves: .obj, .pbrt, .txt (Mitsuba), .usda");
  add_scene_options(*c, scene);
  c->add_option("-o,--output", output, "file to write")->required();
  c->callback([&] { status = wale::run_export(scene, output, loaders); });
  c = app.add_subcommand("compare", "compare two images");
  c->add_option("A", image_a, "image")->required();
  c->add_option("B", image_b, "reference image")->required();
  c->add_option("--max-rmse", max_rmse, "fail when the RMSE is larger");
  c->callback([&] { status = wale::run_compare(image_a, image_b, max_rmse); });
  c = app.add_subcommand("devices", "list the OpenCL devices");
  c->callback([&] { status = wale::run_devices(); });
  c = app.add_subcommand("schema", "print the JSON Schema of scene files");
  c->callback([&] { status = wale::run_schema(); });

  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& e) {
    return app.exit(e);
  } catch (const CLI::ParseError& e) {
    std::fprintf(stderr, "wale: %s (see `wale --help`)\n", e.what());
    return 1;
  }
  return status;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const wale::Error& e) {
    std::fprintf(stderr, "wale: %s\n", e.what());
    return static_cast<int>(e.fault());
  } catch (const cl::Error& e) {
    std::fprintf(stderr, "wale: OpenCL: %s failed with error %d\n", e.what(), e.err());
    return 2;
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "wale: out of memory; use fewer repeats or a smaller film\n");
    return 1;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "wale: a bug: %s\n", e.what());
    return 3;
  }
}
