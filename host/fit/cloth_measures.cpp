#include "host/fit/cloth_measures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace wale::fit {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kMostPlies = 8;
constexpr double kFills = 0.05;  // a ply this near to the one that fills the yarn is that one

// Radius of one of n touching plies over that of the yarn that they fill.
double filling(int plies) {
  if (plies == 1) return 1;
  const double s = std::sin(kPi / plies);
  return s / (1 + s);
}

int plies_of(double ratio) {
  int best = 1;
  for (int n = 2; n <= kMostPlies; ++n)
    if (std::abs(filling(n) - ratio) < std::abs(filling(best) - ratio)) best = n;
  return best;
}

}  // namespace

ClothParameters cloth_parameters(const ClothMeasures& m, double tile_radius, const OwnYarn& own) {
  constexpr double kPer = 0.1;  // gauges are per 10 cm
  ClothParameters out;
  if (m.wale) out.wales = kPer / *m.wale;
  if (m.course) out.courses = kPer / *m.course;
  const double radius = m.yarn ? *m.yarn / 2 : tile_radius;
  if (m.yarn) out.thickness = radius / tile_radius;

  int plies = m.plies.value_or(own.plies);
  double ply_radius = filling(plies) * radius;
  if (m.ply) {
    const double ratio = *m.ply / 2 / radius;
    if (!m.plies) {
      plies = plies_of(ratio);
      out.notes.push_back(
          fmt::format("plies of {:.0f} % of the yarn's diameter: {} of them fill it; count them if you can (--plies)",
                      100 * ratio, plies));
    }
    ply_radius = *m.ply / 2;
    const double expected = filling(plies) * radius;
    if (std::abs(ply_radius - expected) > kFills * expected) {
      out.ply_radius = ply_radius;
      out.notes.push_back(fmt::format("{} plies that fill this yarn and touch would be {:.3g} mm thick: these {}",
                                      plies, 2000 * expected,
                                      ply_radius > expected ? "press into each other" : "lie apart"));
    } else {
      ply_radius = expected;
    }
  }
  if (m.ply || m.plies) out.plies = plies;
  if (m.angle && plies > 1) {
    const double helix = radius - ply_radius;
    out.twist_pitch = 2 * kPi * helix / (std::tan(*m.angle) * radius);
  } else if (m.angle) {
    out.notes.emplace_back("one ply has no angle to the yarn's axis: --angle says nothing here");
  }
  return out;
}

}  // namespace wale::fit
