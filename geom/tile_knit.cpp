#include "geom/tile_knit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geom/cycle_samples.h"

namespace wale {
namespace {

constexpr int kMostPlies = 6;  // (16 / n + 3) n points a leaf, at most 32

TileVertex tie(const dvec3& position, const dvec3& normal, double height, dvec2 tile, int cells) {
  const dvec2 at = dvec2(position) / tile * double(cells), corner = glm::floor(at), f = at - corner;
  const dvec2 slope = dvec2(normal) / tile * double(cells);  // cells per metre along the frame normal
  const double z = position.z + height;
  const double w[4] = {(1 - f.x) * (1 - f.y), f.x * (1 - f.y), (1 - f.x) * f.y, f.x * f.y};
  const double a[4] = {-slope.x * (1 - f.y) - slope.y * (1 - f.x), slope.x * (1 - f.y) - slope.y * f.x,
                       -slope.x * f.y + slope.y * (1 - f.x), slope.x * f.y + slope.y * f.x};
  TileVertex vertex;
  vertex.cell = ivec2(corner);
  for (int c = 0; c < 4; ++c) {
    vertex.w[c] = float(w[c]);
    vertex.h[c] = float(w[c] * z);
    vertex.a[c] = float(a[c]);
    vertex.b[c] = float(a[c] * z + w[c] * normal.z);
  }
  return vertex;
}

}  // namespace

std::string tile_knit_obstacle(const Pattern& pattern, const PartnerMap& partners, int plies) {
  if (plies > kMostPlies)
    return fmt::format("yarns of {} plies: at most {} can be warped on the fly", plies, kMostPlies);
  for (const YarnChain& yarn : tile_yarns(pattern, partners))
    if (yarn.shift != ivec2(1, 0) && yarn.shift != ivec2(0, 1))
      return fmt::format("pattern '{}' has a yarn that goes on {} columns and {} rows further, not in the next tile",
                         pattern.name, yarn.shift.x, yarn.shift.y);
  return {};
}

TileKnit knit_tile(const Pattern& pattern, const PartnerMap& partners, const YarnSpec& spec, dvec3 scale, int cells,
                   double height) {
  TileKnit knit;
  knit.plies = spec.plies;
  knit.cells = cells;
  knit.ply_radius = spec.ply_radius;
  const dvec2 tile = pattern.period * dvec2(scale);
  const std::vector<CycleSamples> cycles = sample_tile(pattern, partners, spec, scale, {1, 1}).cycles;
  // A torus of one tile: yarns close on themselves after one pass, twist and frames included.
  knit_flat(pattern, partners, spec, scale, {{0, 0}, {1, 1}, {1, 1}}, [&](const FlatYarn& flat) {
    const size_t total = flat.centre.size();
    TileYarn yarn;
    yarn.samples = uint32_t(total - 3);
    const dvec3 shift = flat.centre[total - 2] - flat.centre[1];
    yarn.axis = std::abs(shift.x) > std::abs(shift.y) ? 0 : 1;
    ivec2 lap(0);
    lap[yarn.axis] = cells;
    const CycleSamples& cycle = cycles[knit.yarns.size()];
    const double turns = spec.twist * cycle.length + cycle.turn / (2 * std::numbers::pi);
    yarn.twist_change = (std::round(turns) - turns) / cycle.length;
    for (int p = 0; p < spec.plies; ++p) {
      const size_t first = size_t(p) * total;
      const double length = flat.length[first + total - 2] - flat.length[first + 1];
      yarn.lap.push_back(length);
      std::vector<TileVertex> own;
      for (uint32_t k = 0; k < yarn.samples; ++k) {
        const size_t i = first + 1 + k;
        own.push_back(tie(flat.position[i], flat.normal[i], height, tile, cells));
        own.back().length = flat.length[i] - flat.length[first + 1];
        knit.highest = std::max(knit.highest, std::abs(flat.position[i].z + height));
      }
      // Copies of vertices lie exactly one tile further: the same weights, so that leaves on either side agree.
      for (int k = -1; k <= int(yarn.samples) + 1; ++k) {
        const int laps = k < 0 ? -1 : k / int(yarn.samples);
        TileVertex vertex = own[size_t(k - laps * int(yarn.samples))];
        vertex.cell += laps * lap;
        vertex.length += laps * length;
        knit.reach_lo = glm::min(knit.reach_lo, vertex.cell);
        knit.reach_hi = glm::max(knit.reach_hi, vertex.cell);
        yarn.vertex.push_back(vertex);
      }
    }
    knit.yarns.push_back(std::move(yarn));
  });
  return knit;
}

}  // namespace wale
