#include "host/fit/command_measure.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "geom/error.h"
#include "host/fit/cloth_measures.h"
#include "host/json_document.h"
#include "host/suggest.h"

namespace wale {
namespace {

using fit::ClothMeasures;
using fit::ClothParameters;

constexpr double kMillimetre = 1e-3, kDegree = std::numbers::pi / 180;

size_t fabric_of(const Scene& scene, const std::string& wanted) {
  if (scene.fabrics.empty()) user_error("{}: fabrics: there is none to be measured", scene.file);
  if (wanted.empty()) {
    if (scene.fabrics.size() > 1)
      user_error("{}: there are {} fabrics; choose one: --fabric 0 to {}", scene.file, scene.fabrics.size(),
                 scene.fabrics.size() - 1);
    return 0;
  }
  std::vector<std::string> names;
  for (size_t i = 0; i < scene.fabrics.size(); ++i) {
    if (wanted == scene.fabrics[i].spec.name || wanted == std::to_string(i)) return i;
    names.push_back(scene.fabrics[i].spec.name.empty() ? std::to_string(i) : scene.fabrics[i].spec.name);
  }
  user_error("--fabric: none is called '{}'; {}", wanted, nearest_choice(wanted, names));
}

std::optional<double> length_of(const std::optional<double>& given, const MeasureArgs& args) {
  return given ? std::optional(*given * kMillimetre / args.scale.value_or(1)) : std::nullopt;
}

double metres_per_unit(const MeasureArgs& args) {
  const JsonNode document = read_json(args.scene);
  const JsonNode* units = document.find("units");
  return units && units->text == "mm" ? kMillimetre : 1;
}

// Within what a scene may say, before anything is knitted.
void require_sane(const ClothMeasures& m) {
  const auto require = [](bool good, const char* what) {
    if (!good) user_error("measure: {}", what);
  };
  require(m.wale || m.course || m.yarn || m.ply || m.angle || m.plies,
          "nothing was measured; give some of --wale, --course, --yarn, --ply, --angle, --plies");
  require(!m.course || m.wale, "--course without --wale; a gauge begins with the wales");
  require(!m.ply || !m.yarn || *m.ply <= *m.yarn, "--ply: a ply cannot be thicker than its yarn (--yarn)");
  require(!m.angle || (std::abs(*m.angle) > 0.5 * kDegree && std::abs(*m.angle) < 80 * kDegree),
          "--angle: valid: 0.5 to 80 degrees to the yarn's axis; negative for left-handed plies");
}

}  // namespace

int run_measure(const MeasureArgs& args, const Loaders& loaders) {
  ClothMeasures m;
  m.wale = length_of(args.wale, args);
  m.course = length_of(args.course, args);
  m.yarn = length_of(args.yarn, args);
  m.ply = length_of(args.ply, args);
  if (args.angle) m.angle = *args.angle * kDegree;
  m.plies = args.plies;
  require_sane(m);
  Scene scene = read_scene(args);
  const size_t f = fabric_of(scene, args.fabric);
  FabricScene& fabric = scene.fabrics[f];
  const fit::OwnYarn own{fabric.spec.plies, fabric.spec.twist_pitch};
  if (m.wale) {
    fabric.spec.scale.kind = FabricScale::Kind::gauge;
    fabric.spec.scale.gauge = {1 / *m.wale, m.course ? 1 / *m.course : 0};
  }
  // The yarn that the tile brings at this gauge is known when it has been knitted.
  fabric.spec.thickness = 1;
  fabric.spec.ply_radius = 0;
  scene.fabrics = {FabricScene(fabric)};
  scene.objects.clear();
  const World world = build_world(scene, loaders);
  const double tile_radius = world.fabrics.front().yarn_radius;

  const ClothParameters p = fit::cloth_parameters(m, tile_radius, own);
  const std::string key = "fabrics." + std::to_string(f);
  if (p.wales && p.courses)
    fmt::print("--set '{}.gauge={{\"wales\":{:.4g},\"courses\":{:.4g}}}'\n", key, *p.wales, *p.courses);
  else if (p.wales)
    fmt::print("--set '{}.gauge={{\"wales\":{:.4g}}}'\n", key, *p.wales);
  if (p.thickness) fmt::print("--set {}.yarn.thickness={:.4g}\n", key, *p.thickness);
  if (p.plies) fmt::print("--set {}.yarn.plies={}\n", key, *p.plies);
  if (p.ply_radius) fmt::print("--set {}.yarn.ply_radius={:.4g}\n", key, *p.ply_radius / metres_per_unit(args));
  if (p.twist_pitch) fmt::print("--set {}.yarn.twist_pitch={:.4g}\n", key, *p.twist_pitch);
  for (const std::string& note : p.notes) fmt::print(stderr, "note: {}\n", note);
  if (p.thickness && std::abs(*p.thickness - 1) > 0.15) {
    std::string knit = fmt::format("wale knit CHART -o tile.json --yarn {:.4g}", *m.yarn / kMillimetre);
    if (p.wales) knit += fmt::format(" --wales {:.4g}", *p.wales);
    fmt::print(
        stderr,
        "note: the tile's yarn is {:.3g} mm thick at this gauge; scaling it to {:.3g} mm leaves its loops as they "
        "are. A tile of its own has them as such yarn lies: {}\n",
        2000 * tile_radius, *m.yarn / kMillimetre, knit);
  }
  return 0;
}

}  // namespace wale
