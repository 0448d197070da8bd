#include "geom/fibre_bundle.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "appearance/fibre_phase.clh"

namespace wale {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;

double whole_turns(double twist, double ply_radius) {
  return kTwoPi * double(w_turns_per_period(float(twist))) / (double(W_LENGTH_PERIOD) * double(float(ply_radius)));
}

}  // namespace

FibreBundle::FibreBundle(const FibreRecipe& recipe, double ply_radius)
    : recipe_(recipe),
      ply_radius_(ply_radius),
      section_(make_fibre_section(recipe)),
      kappa_(whole_turns(recipe.twist, ply_radius)) {}

double FibreBundle::migration_per_metre(double lap) const {
  const double rate = whole_turns(recipe_.migration_rate * recipe_.twist, ply_radius_);
  return lap > 0 ? kTwoPi * std::round(lap * rate / kTwoPi) / lap : rate;
}

dvec2 FibreBundle::offset(size_t fibre, double l, double migration) const {
  const FibreSection::Fibre& f = section_.fibres[fibre];
  FibreRecipe swing = recipe_;
  swing.migration_rate = 1;
  const double rho = ply_radius_ * fibre_distance(f, swing, migration * l), angle = f.angle + kappa_ * l;
  return {rho * std::cos(angle), rho * std::sin(angle)};
}

void FibreBundle::groups(uint32_t group, std::vector<uint32_t>& order, std::vector<uint32_t>& first) const {
  order.resize(size());
  std::iota(order.begin(), order.end(), 0u);
  first.assign(1, 0);
  const auto at = [&](uint32_t i) {
    const auto& f = section_.fibres[i];
    return dvec2(f.distance * std::cos(f.angle), f.distance * std::sin(f.angle));
  };
  // Halved across the wider side until a part fits; whole groups on the left keep leaves full.
  const auto split = [&](auto&& self, size_t begin, size_t end) -> void {
    if (end - begin <= group) {
      first.push_back(static_cast<uint32_t>(end));
      return;
    }
    dvec2 lo(1e9), hi(-1e9);
    for (size_t i = begin; i < end; ++i) lo = glm::min(lo, at(order[i])), hi = glm::max(hi, at(order[i]));
    const int axis = hi.y - lo.y > hi.x - lo.x ? 1 : 0;
    const size_t parts = (end - begin + group - 1) / group, left = begin + parts / 2 * group;
    std::sort(order.begin() + std::ptrdiff_t(begin), order.begin() + std::ptrdiff_t(end), [&](uint32_t a, uint32_t b) {
      const double x = at(a)[axis], y = at(b)[axis];
      return x < y || (x == y && a < b);
    });
    self(self, begin, left);
    self(self, left, end);
  };
  split(split, 0, order.size());
}

// In the ply's frame a fibre is rho(l) e(kappa l): its second derivative is at most R (kappa^2 + m k M + m M^2 / 2),
// with m = 1 - migration_min and M the migration in radians per metre.
double winding_curvature(const FibreRecipe& recipe, double ply_radius) {
  const double kappa = std::abs(whole_turns(recipe.twist, ply_radius));
  const double swing = std::abs(whole_turns(recipe.migration_rate * recipe.twist, ply_radius));
  const double m = 1 - recipe.migration_min;
  return ply_radius * (kappa * kappa + m * kappa * swing + 0.5 * m * swing * swing);
}

}  // namespace wale
