#include "host/analysis.h"

#include <fmt/format.h>

#include <algorithm>

namespace wale {
namespace {

// Fibres of this radius, in ply radii, are thinner than any pixel: the kernels' filter then takes all of them away.
constexpr float kUnseenFibre = 1e-20f;
// Of WPlyMaterial::tau_e: nothing passes.
constexpr float kOpaque = -1;

void drop_lights(World& world, const std::vector<PlyReach>& reach) {
  for (size_t i = 0; i < world.lights.lights.size(); ++i) {
    auto why = is_black(world, i);
    if (!why) why = shines_away(world, i, reach);
    if (!why) why = is_enclosed(world, i, reach);
    if (!why) continue;
    world.lights.power[i] = 0;
    world.dropped.push_back({"light " + world.light_names[i], *why + ": it is never sampled"});
  }
  world.lights.choose();
}

void drop_fibre_maps(World& world, const std::vector<PlyReach>& reach) {
  bool seen = false;
  for (size_t i = 0; i < world.fabrics.size(); ++i) {
    WFibreDetail& detail = world.fibres.details[world.fabric_material[i]];
    if (const auto why = is_below_pixels(world, i, reach[i])) {
      detail.fibre_radius = kUnseenFibre;
      world.dropped.push_back({fmt::format("fibre maps of \"{}\"", world.fabrics[i].name), *why});
    } else {
      seen |= detail.level != W_DETAIL_NONE;
    }
  }
  if (seen) return;
  world.fibres.offsets.clear();  // no fibre is looked for
  world.fibres.candidates.clear();
}

void drop_pass_through(World& world) {
  for (size_t i = 0; i < world.fabrics.size(); ++i) {
    WPlyMaterial& material = world.ply_materials[world.fabric_material[i]];
    if (const auto why = is_opaque(material)) {
      material.tau_e = kOpaque;
      world.dropped.push_back({fmt::format("light through plies of \"{}\"", world.fabrics[i].name), *why});
    }
  }
}

}  // namespace

std::optional<std::string> ends_at_first_hit(const World& world) {
  if (!world.lights.any()) return "nothing that shines can be seen";
  const bool curves =
      std::any_of(world.fabrics.begin(), world.fabrics.end(), [](const Fabric& f) { return f.report.segments > 0; });
  const auto& surfaces = world.surface_materials;
  const bool scatters = std::any_of(surfaces.begin(), surfaces.end(), [](const WSurfaceMaterial& m) {
    return m.kind != 0 || m.color.x > 0 || m.color.y > 0 || m.color.z > 0;
  });
  if (curves || scatters) return {};
  return "nothing scatters: there is no fabric, and every surface is black";
}

void drop_what_cannot_matter(World& world) {
  std::vector<PlyReach> reach;
  for (const Fabric& fabric : world.fabrics) reach.push_back(ply_reach(fabric));
  drop_lights(world, reach);
  drop_fibre_maps(world, reach);
  drop_pass_through(world);
  if (const auto why = ends_at_first_hit(world)) {
    world.first_hits_only = true;
    world.dropped.push_back({"paths after the first hit", *why});
  }
}

}  // namespace wale
