#include <fmt/format.h>

#include <cmath>

#include "host/analysis.h"

namespace wale {
namespace {

// Fibre diameters under a pixel at which w_fibre_filtered() leaves nothing, and room for rounding.
constexpr double kUnseen = 2.0 * 1.01;
// 1 / (4 tau^2), the share of a parallel beam as wide as a ply that exp(-2 tau cos gamma) lets pass where tau is large,
// is 2^-24 there.
constexpr float kOpaqueTau = 2048;

}  // namespace

std::optional<std::string> is_below_pixels(const World& world, size_t fabric, const PlyReach& reach) {
  const WFibreDetail& detail = world.fibres.details[world.fabric_material[fabric]];
  if (detail.level != W_DETAIL_MAPS) return {};
  const WCamera& c = world.camera;
  const double film = 2 * double(c.half_height) / c.height;
  double width = film;  // of a pixel at the nearest place
  if (c.kind != 1) {
    const dvec3 from = dvec3(c.origin.x, c.origin.y, c.origin.z) + world.origin;
    width = film * (reach.distance(from) - double(c.aperture));
  }
  double radius = world.fabrics[fabric].ply_radius;
  for (const PlyRun& run : world.fabrics[fabric].runs) radius = std::max(radius, double(run.radius));
  const double diameters = width / (2 * double(detail.fibre_radius) * radius);
  if (!(diameters >= kUnseen)) return {};
  return fmt::format("a pixel covers at least {:.1f} fibre diameters, and from 2 on nothing of them shows", diameters);
}

std::optional<std::string> is_opaque(const WPlyMaterial& material) {
  if (!(material.tau_e > kOpaqueTau)) return {};
  return fmt::format("at an optical radius of {:.4g} it lets pass less than one ray in 2^24", material.tau_e);
}

}  // namespace wale
