#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>

#include "bench/wale_bench/options.h"
#include "geom/base_mesh.h"
#include "geom/error.h"
#include "host/accuracy.h"
#include "host/commands.h"
#include "host/cost/command.h"
#include "host/device.h"
#include "host/device_fault.h"
#include "host/fit/command.h"
#include "host/fit/command_measure.h"
#include "host/serve/command_serve.h"
#include "host/suggest.h"

namespace {

using wale::RenderArgs;
using wale::SceneArgs;

// A finite number, at least 0 or above 0. CLI11's own checks let NaN pass and quote the largest double.
CLI::Validator finite_number(bool zero_too) {
  return CLI::Validator(
      [zero_too](const std::string& text) {
        double value = 0;
        if (CLI::detail::lexical_cast(text, value) && std::isfinite(value) && (value > 0 || (zero_too && value == 0)))
          return std::string();
        return text + (zero_too ? ": a number of at least 0 is needed" : ": a number above 0 is needed");
      },
      "NUMBER");
}

// CLI11 takes "" for a value; where it would mean the same as no option it is a mistake of a script.
CLI::Validator not_empty(const std::string& example) {
  return CLI::Validator(
      [example](const std::string& text) {
        return text.empty() ? "the value is empty; for example " + example : std::string();
      },
      "TEXT");
}

// Of every option that takes a value, after what it asks for itself.
void refuse_empty_values(CLI::App& app) {
  const CLI::Validator filled(
      [](const std::string& text) {
        return text.empty() ? std::string("the value is empty; leave the option out, or give one") : std::string();
      },
      "");
  for (CLI::App* command : app.get_subcommands(nullptr))
    for (CLI::Option* option : command->get_options())
      if (!option->get_lnames().empty() && option->get_items_expected_max() > 0) option->check(filled);
}

void add_scene_options(CLI::App& command, SceneArgs& args) {
  command.add_option("SCENE", args.scene, "scene file")->required();
  command.add_option("--preset", args.preset, "accuracy: " + wale::preset_names() + "; goes before --set")
      ->check(not_empty("draft"));
  command
      .add_option("--set", args.set,
                  "change a key of the scene: key.path=value (repeatable; * = every element of a list)")
      ->allow_extra_args(false);
  command.add_flag("--quiet", args.quiet, "no progress");
}

// Of commands that use a device.
void add_device_options(CLI::App& command, SceneArgs& args, const std::string& device) {
  command.add_option("--device", args.device, "OpenCL device (see `wale devices`): " + device);
  command.add_option("--kernel-dir", args.kernel_dir, "read kernels from this folder instead of the built-in ones");
}

void add_features_option(CLI::App& command, wale::Features& also) {
  command
      .add_option_function<std::string>(
          "--features",
          [&also](const std::string& word) { also = word == "all" ? wale::Features::everything() : wale::Features(); },
          "what is built into the kernels: needed (what the scene calls for, the default) or all; same picture")
      ->check(CLI::IsMember({"needed", "all"}));
}

// Lengths on the command line are millimetres, gauges per 10 cm.
void add_knit_options(CLI::App& command, wale::KnitArgs& args) {
  wale::KnitSettings& s = args.settings;
  const auto scaled = [&command](const char* name, double scale, const char* doc, std::function<void(double)> set) {
    return command
        .add_option_function<double>(
            name, [scale, set](const double& v) { set(v * scale); }, doc)
        ->check(finite_number(std::string_view(name).ends_with("tension") || std::string_view(name) == "--blocking"));
  };
  command.add_option("CHART", args.chart, "stitch chart: text, .json or .knitout")->required();
  command.add_option("-o,--output", args.output, "tile to write (.json)")->required();
  scaled("--yarn", 1e-3, "thickness of the yarn, mm; 1 unless given", [&s](double v) { s.yarn_thickness = v; });
  auto* loop = scaled("--loop", 1e-3, "yarn in one stitch, mm", [&s](double v) { s.loop_length = v; });
  auto* diameters = command
                        .add_option("--loop-diameters", args.loop_diameters,
                                    "yarn in one stitch, in yarn diameters; 13.2 unless given")
                        ->check(finite_number(false));
  diameters->excludes(loop);
  scaled("--wales", 10, "wales per 10 cm to reach by the loop length", [&s](double v) { s.wales = v; });
  scaled("--courses", 10, "courses per 10 cm to reach by the loop length", [&s](double v) { s.courses = v; });
  scaled("--step", 1, "resolution: length of a segment in yarn diameters; 0.6 unless given",
         [&s](double v) { s.step = v; });
  scaled("--blocking", 1, "pull on every row and every wale, as a swatch is pinned out; 0 unless given",
         [&s](double v) { s.blocking = v; });
  command.add_option("--starts", s.starts, "places to relax from: the state of least energy is kept; 4 unless given")
      ->check(CLI::Range(1, 64));
  command.add_flag("--strains", s.strains, "relax stretched and compressed tiles too, for scenes with strain: relaxed");
  command.add_option("--seconds", s.max_seconds, "give up after that time; 600 unless given")
      ->check(finite_number(false));
  command.add_option("--threads", s.threads, "threads; all cores unless given")->check(CLI::Range(1u, 1024u));
  command.add_option("--steps", s.max_steps, "steps of the relaxation, at most")->check(CLI::Range(1, 1 << 24));
  scaled("--course-tension", 1, "pull along the rows on a side of the tile, bending stiffness / diameter^2",
         [&s](double v) { s.tension.x = v; });
  scaled("--wale-tension", 1, "pull along the columns", [&s](double v) { s.tension.y = v; });
  command.add_option("--period", args.period, "WIDTHxHEIGHT of the tile in mm, held; free unless given");
  command.add_option("--json", args.json, "write the report as JSON (- for the terminal)");
  command.add_flag("--quiet", args.quiet, "no progress");
}

void add_fit_options(CLI::App& command, wale::FitArgs& args) {
  command.add_option("--front", args.front, "photograph of the cloth lit from the camera's side");
  command.add_option("--back", args.back, "the same, lit from behind");
  command.add_option("-o,--output", args.output, "material file to write (.json)")->required();
  command.add_option("--material", args.material, "ply material to fit; the scene's only one unless given");
  command.add_option("--parameters", args.parameters,
                     "what to fit, with bounds if others are wanted: transmit,reflect,roughness=5..30; "
                     "default: transmit, reflect, roughness, optical_radius, fibre_twist");
  command.add_option("--resolution", args.resolution, "size of the renders, of the photographs'; 0.1 unless given")
      ->check(finite_number(false));
  command.add_option("--spp", args.samples, "samples per pixel; 32 unless given")->check(CLI::Range(1, 1 << 16));
  command
      .add_option("--final-spp", args.final_samples,
                  "of polishing the best place, all rounds together; 1024 unless given")
      ->check(CLI::Range(1, 1 << 16));
  command.add_option("--starts", args.starts, "places to descend from; 3 unless given")->check(CLI::Range(1, 64));
  command.add_option("--evaluations", args.evaluations, "pairs of renders for one start, at most; 150 unless given")
      ->check(CLI::Range(1, 100000));
  command.add_option("--method", args.method, "paths (derivatives along the paths), differences, or bobyqa")
      ->check(CLI::IsMember({"paths", "differences", "bobyqa"}));
  command.add_option("--minutes", args.minutes, "end after that time with the best so far")
      ->check(finite_number(false));
  command.add_flag("--redo", args.redo, "begin anew, whatever an earlier run left");
  command.add_option("--report", args.report, "page to write (.html): pictures, loss, parameters");
  command.add_option("--progress", args.progress, "picture to write while it fits (.png)");
  command
      .add_option("--transfer", args.transfer, "how the photographs' numbers follow from light; the file says it else")
      ->check(CLI::IsMember({"srgb", "linear"}));
  command.add_option("--grey", args.grey, "x,y,width,height of a grey reference in the front photograph, pixels");
  command.add_option("--grey-reflectance", args.grey_reflectance, "of it; 0.18 unless given");
  command.add_option(
      "--gains", args.gains,
      "red,green,blue: factors on linear light of the front or only photograph, where there is no reference");
  command.add_option("--crop", args.crop, "x,y,width,height of the part with the cloth, pixels");
  command.add_option("--corners", args.corners, "x,y of its four corners instead, clockwise from the top left");
  command
      .add_option("--front-exposure", args.front_exposure,
                  "time x ISO / f-number^2 of the front photograph, in any unit: only its ratio to the back's counts; "
                  "1 unless given")
      ->check(finite_number(false));
  command.add_option("--back-exposure", args.back_exposure, "the same of the back one")->check(finite_number(false));
  command
      .add_option("--clip-level", args.clip_level,
                  "stored value from which a pixel is clipped; 1 in files of whole numbers")
      ->check(finite_number(false));
  command.add_flag("--unaligned", args.unaligned, "photographs show such cloth, not these very stitches");
  command.add_option("--weights", args.weights, "VGG16 weights (.npz or .onnx) for a loss by features");
  command.add_option("--layers", args.layers, "layers of it and their weights: relu1_2=1,relu2_2=0.5");
  command.add_option("--loss", args.terms, "terms and weights: low-pass=1,color=1,gradient=0.1,spectrum=1,feature=0.1");
}

void add_measure_options(CLI::App& command, wale::MeasureArgs& args) {
  command.add_option("--fabric", args.fabric, "name or number; the scene's only one unless given");
  command.add_option("--scale", args.scale, "pixels per mm: lengths are in pixels; else in mm")
      ->check(finite_number(false));
  const auto length = [&](const char* name, std::optional<double>& to, const char* doc) {
    command.add_option(name, to, doc)->check(finite_number(false));
  };
  length("--wale", args.wale, "distance of neighbouring wales");
  length("--course", args.course, "distance of neighbouring courses");
  length("--yarn", args.yarn, "diameter of the yarn");
  length("--ply", args.ply, "diameter of a ply");
  command.add_option("--angle", args.angle, "of the plies to the yarn's axis, degrees; negative: left-handed");
  command.add_option("--plies", args.plies, "plies in the yarn")->check(CLI::Range(1, 8));
}

// What CLI11 could not place, with the nearest valid word.
std::string advice(const CLI::App& app, const CLI::ParseError& error) {
  const std::vector<std::string> left = app.remaining(true);
  const auto chosen = app.get_subcommands();
  if (chosen.empty()) {
    std::vector<std::string> names;
    for (const auto* command : app.get_subcommands(nullptr)) names.push_back(command->get_name());
    if (left.empty()) return "a command is needed; " + wale::nearest_choice("", names);
    return left.front() + ": no such command; " + wale::nearest_choice(left.front(), names);
  }
  if (dynamic_cast<const CLI::ExtrasError*>(&error) == nullptr || left.empty()) return error.what();
  const auto option = std::find_if(left.begin(), left.end(), [](const auto& word) { return word.starts_with("-"); });
  if (option == left.end()) return left.front() + ": one word too many";
  std::vector<std::string> names;
  for (const auto* known : chosen.front()->get_options())
    for (const auto& name : known->get_lnames()) names.push_back("--" + name);
  return *option + ": no such option of `wale " + chosen.front()->get_name() + "`; " +
         wale::nearest_choice(*option, names);
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
  add_device_options(*c, render, "its number, several with commas between them, or all");
  add_features_option(*c, render.also);
  c->add_option("-o,--output", render.outputs, "image to write (repeatable)")->required()->allow_extra_args(false);
  c->add_option("--spp", render.spp, "samples per pixel; with --error the most")->check(CLI::Range(1, 1 << 24));
  c->add_option("--error", render.error, "stop each tile at this noise, relative to its mean: 0.05")
      ->check(finite_number(false));
  c->add_option("--seconds", render.seconds, "stop after this many seconds of rendering")->check(finite_number(false));
  c->add_option("--size", render.size, "WIDTHxHEIGHT")->check(not_empty("512x512"));
  c->add_option("--stats", render.stats, "write what was done as JSON")->check(not_empty("stats.json"));
  c->add_option("--frames", render.frames,
                "frames of an animation: 7, 0..47 or 0..47:2; # in an output is a digit of the number")
      ->check(not_empty("0..47"));
  c->add_flag("--redo", render.redo, "write over frames of another scene or other settings");
  c->add_option("--video", render.video, "join the frames to a video (needs ffmpeg)")->check(not_empty("film.mp4"));
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
  add_device_options(*c, scene, "its number");
  add_features_option(*c, scene.also);
  c->add_option("--json", json, "write the plan as JSON (- for the terminal)");
  c->callback([&] { status = wale::run_plan(scene, json, loaders); });
  wale::CostArgs cost;
  for (int i = 0; i < argc; ++i) cost.command += (i ? " " : "") + std::string(argv[i]);
  c = app.add_subcommand("cost",
                         "measure what every accuracy option costs on this scene and device, and what it changes");
  add_scene_options(*c, cost);
  add_device_options(*c, cost, "its number");
  c->add_option("-o,--output", cost.output, "folder for cost.csv, cost.json, pareto.svg, pareto.png, index.html")
      ->required();
  c->add_option("--minutes", cost.minutes, "time for everything, 10 unless given")->check(finite_number(false));
  c->add_option("--size", cost.size, "WIDTHxHEIGHT; default: the film's, made smaller");
  c->add_option("--reference", cost.reference, "compare with this .exr of `wale render` instead of rendering one");
  c->add_option("--options", cost.options, "only these, with commas between them; presets stands for the presets");
  c->callback([&] { status = wale::run_cost(cost, loaders); });
  c = app.add_subcommand("export", "write the ply curves: .obj, .pbrt, .txt (Mitsuba), .usda");
  add_scene_options(*c, scene);
  add_device_options(*c, scene, "its number");
  c->add_option("-o,--output", output, "file to write")->required();
  c->callback([&] { status = wale::run_export(scene, output, loaders); });
  wale::ServeArgs serve;
  c = app.add_subcommand("serve", "edit a scene in a browser while it renders");
  add_scene_options(*c, serve);
  add_device_options(*c, serve, "its number");
  c->add_option("--port", serve.port, "8737 unless given; 0 = any that is free")->check(CLI::Range(0, 65535));
  c->add_option("--host", serve.host, "address to listen on; only this machine unless given");
  c->add_option("--size", serve.size, "WIDTHxHEIGHT that the picture on the page fits into, 512x512 unless given");
  c->callback([&] { status = wale::run_serve(serve, loaders); });
  wale::FitArgs fit;
  fit.command = cost.command;
  c = app.add_subcommand("fit", "fit a material to photographs that are lit from the front and from behind");
  add_scene_options(*c, fit);
  add_device_options(*c, fit, "its number");
  add_fit_options(*c, fit);
  c->callback([&] { status = wale::run_fit(fit, loaders); });
  wale::MeasureArgs measure;
  c = app.add_subcommand("measure",
                         "turn lengths and angles measured on a picture into a scene's gauge, yarn and plies");
  add_scene_options(*c, measure);
  add_measure_options(*c, measure);
  c->callback([&] { status = wale::run_measure(measure, loaders); });
  wale::KnitArgs knit;
  c = app.add_subcommand("knit", "relax a stitch chart into a tile of yarn");
  add_knit_options(*c, knit);
  c->callback([&] { status = wale::run_knit(knit); });
  c = app.add_subcommand("compare", "compare two images");
  c->add_option("A", image_a, "image")->required();
  c->add_option("B", image_b, "reference image")->required();
  c->add_option("--max-rmse", max_rmse, "fail when the RMSE is larger")->check(finite_number(true));
  c->callback([&] { status = wale::run_compare(image_a, image_b, max_rmse); });
  wale::bench::BenchArgs bench;
  c = app.add_subcommand("bench", "throughput of this device, stage by stage; without options, the score");
  wale::bench::add_bench_options(*c, bench);
  c->callback([&] { status = wale::bench::run_bench(bench, loaders); });
  c = app.add_subcommand("devices", "list the OpenCL devices");
  c->callback([&] {
    status = wale::run_devices();
    wale::print_editor_note();
  });
  c = app.add_subcommand("schema", "print the JSON Schema of scene files");
  c->callback([&] { status = wale::run_schema(); });

  refuse_empty_values(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& e) {
    return app.exit(e);
  } catch (const CLI::ParseError& e) {
    std::fprintf(stderr, "wale: %s (see `wale --help`)\n", wale::one_line(advice(app, e)).c_str());
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
    std::fprintf(stderr, "wale: %s\n", wale::opencl_fault(e).c_str());
    return 2;
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "wale: out of memory; use fewer repeats or a smaller film\n");
    return 1;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "wale: a bug: %s\n", e.what());
    return 3;
  }
}
