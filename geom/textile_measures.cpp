#include "geom/textile_measures.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geom/cycle_samples.h"
#include "geom/error.h"
#include "geom/fabric_map.h"

namespace wale {
namespace {

constexpr double kTolerance = 0.01;  ///< ply radii: lengths are then within 1e-4

/// Points of the rectangle from (0,0) to `size` that discs swept along segments hide.
class CoverRaster {
 public:
  CoverRaster(dvec2 size, int points) : step_(size / double(points)), points_(points) {
    hidden_.assign(size_t(points) * size_t(points), false);
  }

  void add(dvec2 a, dvec2 b, double radius) {
    const dvec2 most(points_ - 1);
    const dvec2 lo = glm::max(glm::ceil((glm::min(a, b) - radius) / step_ - 0.5), dvec2(0));
    const dvec2 hi = glm::min(glm::floor((glm::max(a, b) + radius) / step_ - 0.5), most);
    const dvec2 ab = b - a;
    const double length2 = glm::dot(ab, ab);
    for (long j = long(lo.y); j <= long(hi.y); ++j)
      for (long i = long(lo.x); i <= long(hi.x); ++i) {
        const dvec2 p = (dvec2(double(i), double(j)) + 0.5) * step_;
        const double t = length2 > 0 ? std::clamp(glm::dot(p - a, ab) / length2, 0.0, 1.0) : 0;
        const dvec2 off = p - a - t * ab;
        if (glm::dot(off, off) <= radius * radius) hidden_[size_t(j) * size_t(points_) + size_t(i)] = true;
      }
  }
  double share() const { return double(std::count(hidden_.begin(), hidden_.end(), true)) / double(hidden_.size()); }

 private:
  dvec2 step_;
  int points_;
  std::vector<bool> hidden_;
};

}  // namespace

double TextileMeasures::tightness() const { return std::sqrt(tex()) / (100 * yarn_per_stitch); }

TextileMeasures measure_textile(const Pattern& pattern, const YarnSpec& yarn, dvec2 tile,
                                const YarnSubstance& substance, int raster) {
  if (!(tile.x > 0 && tile.y > 0)) bug("textile measures of a tile of {} x {} m", tile.x, tile.y);
  const PartnerMap partners = match_partners(pattern);
  YarnSpec fine = yarn;
  fine.tolerance = kTolerance;
  fine.places = false;
  const dvec2 across = tile / pattern.period;
  const dvec3 scale(across, std::sqrt(across.x * across.y));
  double yarn_length = 0;
  for (const CycleSamples& cycle : sample_tile(pattern, partners, fine, scale).cycles) yarn_length += cycle.length;

  // The twist does not repeat with the tile, so that a block of tiles gives a better mean; two more on each side bring
  // all yarn that reaches into it.
  constexpr int kBlock = 4;
  double axis = 0, plies = 0;
  CoverRaster cover(tile * double(kBlock), raster);
  const InstanceRect rect{{-2, -2}, {kBlock + 2, kBlock + 2}, {0, 0}};
  knit_flat(pattern, partners, fine, scale, rect, [&](FlatYarn&& flat) {
    const size_t count = flat.centre.size(), first = flat.closed ? 1 : 0, last = count - (flat.closed ? 2 : 1);
    for (size_t k = first; k < last; ++k) axis += glm::distance(flat.centre[k], flat.centre[k + 1]);
    for (int p = 0; p < fine.plies; ++p)
      for (size_t k = first; k < last; ++k) {
        const dvec3 a = flat.position[size_t(p) * count + k], b = flat.position[size_t(p) * count + k + 1];
        plies += glm::distance(a, b);
        cover.add(dvec2(a), dvec2(b), fine.ply_radius);
      }
  });

  TextileMeasures m;
  const double stitches = std::max(1, pattern.stitches.x) * std::max(1, pattern.stitches.y);
  m.yarn_per_stitch = yarn_length / stitches;
  m.ply_per_yarn = plies / (axis * fine.plies);
  m.yarn_mass = substance.density * substance.packing * std::numbers::pi * fine.ply_radius * fine.ply_radius *
                m.ply_per_yarn * fine.plies;
  m.area_mass = m.yarn_mass * yarn_length / (tile.x * tile.y);
  m.cover = cover.share();
  return m;
}

TextileMeasures measure_textile(const Fabric& fabric, const Pattern& pattern, const FabricSpec& spec,
                                const YarnSubstance& substance) {
  const FabricMap map = map_fabric(fabric.mesh, fabric.charts, pattern, spec);
  return measure_textile(pattern, map.yarn, map.tile_metres, substance);
}

}  // namespace wale
