#include "host/fit/command.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "geom/byte_source.h"
#include "geom/error.h"
#include "host/atomic_file.h"
#include "host/device.h"
#include "host/fit/journal_file.h"
#include "host/fit/loss_words.h"
#include "host/fit/material_json.h"
#include "host/fit/photograph_words.h"
#include "host/fit/report.h"
#include "host/fit/resample.h"
#include "host/progress.h"
#include "host/scene_identity.h"
#include "host/stop.h"
#include "host/suggest.h"

namespace wale {
namespace {

using namespace wale::fit;

constexpr double kNoisy = 10;  // times the loss

// The ply material that is fitted, by name or because there is one.
FitTarget target_of(const Scene& scene, const std::string& name) {
  std::vector<std::string> names;
  std::optional<size_t> found;
  for (size_t i = 0; i < scene.materials.size(); ++i) {
    if (!scene.materials[i].ply) continue;
    names.push_back(scene.materials[i].name);
    if (name.empty() || names.back() == name) found = i;
  }
  if (names.empty()) user_error("{}: materials: none is a ply's; there is nothing to fit", scene.file);
  if (!found) user_error("--material: no ply material is called '{}'; {}", name, nearest_choice(name, names));
  if (name.empty() && names.size() > 1)
    user_error("{}: there are {} ply materials; choose one: --material {}", scene.file, names.size(), names.front());
  FitTarget target;
  target.material = *found;
  for (size_t f = 0; f < scene.fabrics.size(); ++f)
    if (size_t(scene.fabrics[f].material) == *found) target.fabrics.push_back(f);
  const MaterialSpec& material = scene.materials[*found];
  if (target.fabrics.empty()) user_error("{}: no fabric is made of '{}'", scene.file, material.name);
  const PlyAppearance& yarn = material.yarn;
  const char* varies = !yarn.plies.empty()                             ? "plies"
                       : !yarn.stripes.empty()                         ? "stripes"
                       : yarn.heather_yarn > 0 || yarn.heather_ply > 0 ? "heather"
                                                                       : nullptr;
  if (varies)
    user_error("{}: materials.{}.{}: a fit has one colour; take the key away (--set materials.{}.{}=null)", scene.file,
               material.name, varies, material.name, varies);
  return target;
}

// The share of the photographs' size that is rendered.
void take_size(Scene& scene, int width, int height, double resolution) {
  const double aspect = double(width) / height, own = double(scene.film.width) / scene.film.height;
  if (std::abs(aspect / own - 1) > 0.02)
    user_error(
        "{}: film.size is {} x {}, the photographs' part is {} x {}: of another shape; give --crop or --corners of the "
        "shape that the camera sees, or film.size (--set film.size=[{},{}])",
        scene.file, scene.film.width, scene.film.height, width, height, width, height);
  scene.film.width = std::max(16, int(std::lround(width * resolution)));
  scene.film.height = std::max(16, int(std::lround(height * resolution)));
  if (double(scene.film.width) > width || double(scene.film.height) > height)
    user_error("--resolution {:g}: {} x {} pixels of photographs that have {} x {}; valid: at most 1, and 16 pixels",
               resolution, scene.film.width, scene.film.height, width, height);
}

uint64_t hash_file(const std::filesystem::path& file, uint64_t seed) {
  if (file.empty()) return seed;
  std::ifstream in(file, std::ios::binary);
  std::ostringstream bytes;
  bytes << in.rdbuf();
  return hash_bytes(bytes.str(), seed);
}

// Whatever changes what is fitted.
std::string identity_of(const FitArgs& args, const FitSettings& settings, const Scene& scene) {
  uint64_t hash = kHashSeed;
  for (const auto& file : {args.front, args.back, args.weights}) hash = hash_file(file, hash);
  std::string words = fmt::format(
      "{} {} {}x{} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {}", scene_identity(args.scene, args.set), args.preset,
      scene.film.width, scene.film.height, scene.film.exposure, settings.target.material, settings.starts,
      settings.samples, settings.final_samples, args.method, args.transfer, args.grey, args.gains, args.crop,
      args.corners, args.grey_reflectance, args.front_exposure, args.back_exposure, args.terms, args.layers);
  words += args.unaligned ? " unaligned" : "";
  for (const FitParameter& p : settings.parameters) words += fmt::format(" {}={}..{}", p.name(), p.low, p.high);
  return fmt::format("{:016x}", hash_bytes(words, hash));
}

std::string progress_note(const FitJournal& journal, size_t starts) {
  double best = INFINITY;
  for (const FitStep& s : journal.steps)
    if (s.start >= 0) best = std::min(best, s.loss);
  const int start = journal.steps.empty() ? -1 : journal.steps.back().start;
  const std::string where = start < 0             ? "looking for starts"
                            : start < int(starts) ? fmt::format("start {} of {}", start + 1, starts)
                                                  : "polishing the best";
  return fmt::format("{}, {} pairs{}", where, journal.steps.size(),
                     std::isfinite(best) ? fmt::format(", loss {:.4g}", best) : "");
}

}  // namespace

int run_fit(const FitArgs& args, const Loaders& loaders) {
  if (args.front.empty() && args.back.empty())
    user_error("fit: photographs are needed: --front FILE and --back FILE, of the cloth lit from either side");
  FitSettings settings;
  settings.parameters = fit_parameters(args.parameters);
  settings.method = args.method == "bobyqa"        ? FitMethod::bobyqa
                    : args.method == "differences" ? FitMethod::differences
                                                   : FitMethod::paths;
  settings.starts = args.starts;
  settings.samples = args.samples;
  settings.final_samples = args.final_samples;
  settings.evaluations = args.evaluations;
  settings.seconds = 60 * args.minutes;
  Scene scene = read_scene(args);
  settings.target = target_of(scene, args.material);
  const std::array<bool, 2> sides{!args.front.empty(), !args.back.empty()};
  for (size_t side = 0; side < 2; ++side)
    if (sides[side]) lit_from(scene, side);
  for (const auto& file : {args.output, args.report})
    if (!file.empty()) require_writable_path(file);
  if (!args.progress.empty()) require_writable(args.progress);
  const std::filesystem::path journal_path = args.output.string() + ".fit";

  FitReport report;
  std::vector<std::string>& warnings = report.warnings;
  PicturePair photographs = read_photographs(args, warnings);
  const Picture& any = sides[0] ? photographs.front : photographs.back;
  take_size(scene, any.width, any.height, args.resolution);
  for (Picture* side : {&photographs.front, &photographs.back})
    if (side->count()) *side = at_resolution(*side, scene.film.width, scene.film.height);
  if (sides != std::array{true, true})
    warnings.push_back(
        fmt::format("only the photograph lit from the {} is given: how light is shared between transmission and "
                    "reflection is not in it",
                    sides[0] ? "front" : "back"));
  const NamedLoss loss(args, photographs, warnings);
  settings.cells = loss.cells();
  if (!args.quiet)
    for (const std::string& warning : warnings) fmt::print(stderr, "warning: {}\n", warning);

  const std::string identity = identity_of(args, settings, scene);
  FitJournal journal;
  if (!args.redo)
    if (auto before = read_journal(journal_path, identity, settings.parameters.size())) {
      journal = std::move(*before);
      if (!args.quiet) fmt::print(stderr, "note: goes on after {} pairs of renders\n", journal.steps.size());
    }

  const Device device = Device::open(one_device_number(args.device));
  LitPair renderer(device, loaders, args.kernel_dir, sides);
  Fit fit(
      scene, renderer, [&](const PicturePair& pair) { return loss.residuals(pair); }, settings);
  catch_stop_signals();
  Progress bar("fit", args.quiet);
  double written = 0;
  const auto result = fit.run(journal, stop_requested, [&](const FitProgress& p) {
    // About as many pairs as an ordinary fit takes: nobody knows how many are left.
    const double expected = 12.0 * settings.starts + 4.0 * double(settings.parameters.size()) * settings.starts;
    bar.update(1 - std::exp(-double(journal.steps.size()) / expected), progress_note(journal, size_t(settings.starts)));
    if (p.better && !args.progress.empty())
      write_image(side_by_side(photographs, *p.pictures), args.progress, scene.film.exposure, "srgb");
    if (const double seconds = journal.steps.back().seconds; seconds > written + 5) {
      journal.seconds = written = seconds;
      write_journal(journal, identity, journal_path);
    }
  });
  if (!result) {
    write_journal(journal, identity, journal_path);
    bar.finish("stopped");
    fmt::print(stderr, "note: stopped after {} pairs of renders; the same command goes on from there\n",
               journal.steps.size());
    return 0;
  }
  bar.finish();

  std::vector<std::string> doubts = parameter_warnings(settings, *result);
  if (result->render_noise > kNoisy * std::abs(result->best.loss))
    doubts.push_back(
        fmt::format("the renders' noise ({:.2g}) is far above the loss ({:.2g}), which may be a chance of it: "
                    "--final-spp {} has half",
                    result->render_noise, result->best.loss, 2 * settings.final_samples));
  for (const std::string& doubt : doubts) {
    warnings.push_back(doubt);
    if (!args.quiet) fmt::print(stderr, "warning: {}\n", doubt);
  }
  for (size_t k = 0; k < result->parameters.size(); ++k)
    fmt::print("{}\n", parameter_line(settings.parameters[k], result->parameters[k]));
  fmt::print("loss {:.4g}, of which noise of the renders {:.2g}; {} pairs of renders in {}\n", result->best.loss,
             result->render_noise, journal.steps.size(), duration_text(journal.seconds));
  if (!args.report.empty()) {
    report.scene = args.scene.string();
    report.command = args.command;
    report.device = device.traits().name;
    report.loss = loss.words();
    report.photographs = photographs;
    write_text_file(args.report, report_html(report, settings, journal, *result));
  }
  if (!result->best.converged && !result->out_of_time) {
    write_journal(journal, identity, journal_path);
    user_error("{}: the fit had not converged after {} pairs of renders, loss {:.4g}; nothing was written; {}",
               args.output.string(), journal.steps.size(), result->best.loss,
               result->polished
                   ? fmt::format("--evaluations {} goes on from there", 2 * settings.evaluations)
                   : fmt::format("polishing went on moving: --final-spp {} may settle it", 4 * settings.final_samples));
  }
  if (!result->best.converged && !args.quiet)
    fmt::print(stderr, "warning: --minutes {:g} were over before the fit had converged\n", args.minutes);
  write_text_file(args.output, material_json(result->scene, settings.target));
  if (const std::string more = other_settings(result->scene, settings.target, settings.parameters); !more.empty())
    fmt::print("beside the material:\n{}", more);
  std::error_code ignored;
  std::filesystem::remove(journal_path, ignored);
  return 0;
}

}  // namespace wale
