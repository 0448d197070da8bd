#include "geom/fibre_detail.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace wale {
namespace {

constexpr double kPi = std::numbers::pi, kTwoPi = 2 * kPi;

/// Where the line from outside towards the axis at azimuth `off` from the fibre's centre meets it; 0 = it does not.
double meets(double distance, double off, double a) {
  const double across = distance * std::sin(off);
  if (std::abs(across) >= a) return 0;
  return std::max(0.0, distance * std::cos(off) + std::sqrt(a * a - across * across));
}

}  // namespace

FibreDetail::FibreDetail(const FibreRecipe& recipe) : recipe_(recipe), section_(make_fibre_section(recipe)) {
  fill_bins();
  average();
}

// A fibre matters in a bin where it may be the outermost one, or where it stands beside what is and shades it: its
// circle, grown by two radii to either side, covers part of the bin, and it reaches as far out as the shallowest spot.
void FibreDetail::fill_bins() {
  constexpr int kProbes = 32;
  const double a = section_.fibre_radius;
  for (int bin = 0; bin < kBins; ++bin) {
    offsets_[size_t(bin)] = uint32_t(candidates_.size());
    const double begin = -kPi + kTwoPi * bin / kBins, width = kTwoPi / kBins;
    double shallowest = 1;
    for (int i = 0; i <= kProbes; ++i) {
      const double phi = begin + width * i / kProbes;
      double surely = 0;  // what is seen here at every phase of the migration
      for (const auto& f : section_.fibres) {
        const double out = meets(f.distance, phi - f.angle, a);
        const double in = meets(f.distance * recipe_.migration_min, phi - f.angle, a);
        if (out > 0 && in > 0) surely = std::max(surely, std::min(out, in));
      }
      shallowest = std::min(shallowest, surely);
    }
    for (uint32_t k = 0; k < section_.fibres.size(); ++k) {
      const auto& f = section_.fibres[k];
      if (f.distance + a < shallowest) continue;
      const double least = f.distance * recipe_.migration_min;
      const double reach = least > 3 * a ? std::asin(3 * a / least) : kPi;
      const double off = std::abs(std::remainder(f.angle - (begin + 0.5 * width), kTwoPi));
      if (off <= reach + 0.5 * width) candidates_.push_back(k);
    }
  }
  offsets_[kBins] = uint32_t(candidates_.size());
}

// The line towards the axis picks the outermost fibre. From there the free directions of the half plane lie between the
// highest neighbour on either side; a neighbour at v = centre - P, |v| = d, covers +- asin(a/d) about v.
FibreDetail::At FibreDetail::at(double phi, double theta) const {
  const double a = section_.fibre_radius;
  const double psi = std::remainder(phi - theta, kTwoPi);
  const int bin = std::clamp(int(std::floor((psi + kPi) / kTwoPi * kBins)), 0, kBins - 1);
  At best;
  uint32_t winner = 0;
  const uint32_t first = offsets_[size_t(bin)], last = offsets_[size_t(bin) + 1];
  for (uint32_t i = first; i < last; ++i) {
    const auto& f = section_.fibres[candidates_[i]];
    const double distance = fibre_distance(f, recipe_, theta), off = psi - f.angle;
    const double radius = meets(distance, off, a);
    if (radius <= best.radius) continue;
    best = {true, radius, distance * std::sin(off) / a, distance, 0};
    winner = i;
  }
  if (!best.fibre) return best;
  double left = best.sin_turn, right = -best.sin_turn;  // cosines of the horizons' angles to the ply's normal
  for (uint32_t i = first; i < last; ++i) {
    if (i == winner) continue;
    const auto& f = section_.fibres[candidates_[i]];
    const double distance = fibre_distance(f, recipe_, theta), off = f.angle - psi;
    const double out = distance * std::cos(off) - best.radius, side = distance * std::sin(off);
    const double d = std::hypot(out, side);
    if (d <= a) continue;  // fibres that migrate may overlap: no horizon from inside
    const double s = a / d, c = std::sqrt(1 - s * s);
    const double horizon = (out * c + std::abs(side) * s) / d;
    (side > 0 ? right : left) = std::max(side > 0 ? right : left, horizon);
  }
  best.openness = (std::acos(std::clamp(left, -1.0, 1.0)) + std::acos(std::clamp(right, -1.0, 1.0))) / kPi;
  return best;
}

void FibreDetail::average() {
  const int around = 2048, along = recipe_.migration_min < 1 ? 24 : 1;
  double openness = 0, distance = 0, tilt = 0, tilt2 = 0;
  for (int j = 0; j < along; ++j)
    for (int i = 0; i < around; ++i) {
      // The twist angle moves the section round as well; the sum over phi takes no notice.
      const double theta = kTwoPi * (j + 0.5) / (along * recipe_.migration_rate + (recipe_.migration_rate == 0));
      const At here = at(kTwoPi * (i + 0.5) / around, theta);
      const double angle = std::atan(recipe_.twist * here.distance);
      openness += here.openness;
      distance += here.distance;
      tilt += angle;
      tilt2 += angle * angle;
    }
  const double n = double(around) * along;
  mean_openness_ = openness / n;
  mean_distance_ = distance / n;
  tilt_variance_ = std::max(0.0, tilt2 / n - (tilt / n) * (tilt / n));
}

}  // namespace wale
