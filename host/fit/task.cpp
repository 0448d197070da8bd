#include "host/fit/task.h"

#include <fmt/format.h>

#include <cmath>

#include "geom/byte_source.h"
#include "geom/error.h"
#include "host/fit/photograph_words.h"
#include "host/fit/resample.h"
#include "host/fit/scene_content.h"
#include "host/scene_identity.h"
#include "host/suggest.h"

namespace wale::fit {
namespace {

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
  constexpr int kFewest = 16;
  const double least = double(kFewest) / std::min(width, height);
  if (!(resolution <= 1) || least > 1)
    user_error("--resolution {:g}: photographs of {} x {} pixels; valid: at most 1, and {} pixels across and down",
               resolution, width, height, kFewest);
  if (resolution < least)
    user_error("--resolution {:g}: {} x {} pixels are left of {} x {}, and {} are needed; valid: {:.2g} and above",
               resolution, int(width * resolution), int(height * resolution), width, height, kFewest,
               std::ceil(100 * least) / 100);
  scene.film.width = int(std::lround(width * resolution));
  scene.film.height = int(std::lround(height * resolution));
}

FitSettings settings_of(const FitArgs& args) {
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
  return settings;
}

}  // namespace

FitTask read_task(const FitArgs& args) {
  if (args.front.empty() && args.back.empty())
    user_error("fit: photographs are needed: --front FILE and --back FILE, of the cloth lit from either side");
  FitTask task;
  task.settings = settings_of(args);
  task.scene = read_scene(args);
  task.settings.target = target_of(task.scene, args.material);
  require_hand(task.scene, task.settings.target, task.settings.parameters);
  task.sides = {!args.front.empty(), !args.back.empty()};
  for (size_t side = 0; side < 2; ++side)
    if (task.sides[side]) lit_from(task.scene, side);

  task.photographs = read_photographs(args, task.warnings);
  const Picture& any = task.sides[0] ? task.photographs.front : task.photographs.back;
  take_size(task.scene, any.width, any.height, args.resolution);
  for (Picture* side : {&task.photographs.front, &task.photographs.back})
    if (side->count()) *side = at_resolution(*side, task.scene.film.width, task.scene.film.height);
  if (task.sides != std::array{true, true})
    task.warnings.push_back(
        fmt::format("only the photograph lit from the {} is given: how light is shared between transmission and "
                    "reflection is not in it",
                    task.sides[0] ? "front" : "back"));
  return task;
}

std::string identity_of(const FitArgs& args, const FitTask& task) {
  const FitSettings& settings = task.settings;
  const Scene& scene = task.scene;
  uint64_t hash = kHashSeed;
  for (const auto& file : {args.front, args.back, args.weights}) hash = hash_file(file, hash);
  for (const auto& file : files_of(scene)) hash = hash_file(file, hash);
  std::string words = fmt::format(
      "{} {} {}x{} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {}", scene_identity(args.scene, args.set), args.preset,
      scene.film.width, scene.film.height, scene.film.exposure, settings.target.material, settings.starts,
      settings.samples, args.method, args.transfer, args.grey, args.gains, args.crop, args.corners,
      args.grey_reflectance, args.front_exposure, args.back_exposure, args.terms, args.layers);
  words += args.unaligned ? " unaligned" : "";
  words += task.sides[0] ? " front" : "";
  words += task.sides[1] ? " back" : "";
  for (const FitParameter& p : settings.parameters) words += fmt::format(" {}={}..{}", p.name(), p.low, p.high);
  words += ' ';
  words += model_words(scene);
  return fmt::format("{:016x}", hash_bytes(words, hash));
}

}  // namespace wale::fit
