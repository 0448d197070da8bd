#include "host/fibre_tables.h"

#include <algorithm>
#include <cmath>

#include "appearance/fibre_phase.clh"

namespace wale {
namespace {

/// Turns per metre of what winds by `angle` radians per ply radius, a whole number per period.
double whole_turns(double angle, double ply_radius) {
  return double(w_turns_per_period(float(angle))) / (double(W_LENGTH_PERIOD) * ply_radius);
}

}  // namespace

bool FibreTables::any() const {
  return std::any_of(details.begin(), details.end(), [](const auto& d) { return d.level != W_DETAIL_NONE; });
}

void FibreTables::add(const FibreRecipe& wanted, double ply_radius, Detail level, const FibreTables* previous) {
  static_assert(W_DETAIL_BINS == FibreDetail::kBins);
  WFibreDetail out{};
  if (level != Detail::paper && level != Detail::maps) {
    details.push_back(out);
    return;
  }
  FibreRecipe recipe = wanted;
  if (level == Detail::paper) recipe.migration_min = 1;
  const auto known = [&]() -> std::shared_ptr<const FibreDetail> {
    for (const FibreTables* tables : {&std::as_const(*this), previous})
      for (size_t i = 0; tables && i < tables->made.size(); ++i)
        if (tables->made[i].from == recipe) return tables->made[i].detail;
    return std::make_shared<FibreDetail>(recipe);
  };
  const Made& section = made.emplace_back(Made{recipe, known()});
  const FibreDetail& detail = *section.detail;
  out.level = level == Detail::paper ? W_DETAIL_PAPER : W_DETAIL_MAPS;
  out.first_offset = w_uint(offsets.size());
  out.turns = float(whole_turns(recipe.twist, ply_radius));
  out.wander = float(whole_turns(recipe.twist * recipe.migration_rate, ply_radius));
  out.fibre_radius = float(detail.fibre_radius());
  out.migration_min = float(recipe.migration_min);
  out.twist = float(recipe.twist);
  out.mean_distance = float(detail.mean_distance());
  out.inv_mean_openness = float(1 / detail.mean_openness());
  out.mean_openness = float(detail.mean_openness());
  out.tilt_variance = float(detail.tilt_variance());
  details.push_back(out);
  const uint32_t base = uint32_t(candidates.size());
  for (const uint32_t offset : detail.offsets()) offsets.push_back(base + offset);
  for (const uint32_t k : detail.candidates()) {
    const auto& fibre = detail.section().fibres[k];
    candidates.push_back(
        {float(fibre.distance), float(std::cos(fibre.angle)), float(std::sin(fibre.angle)), float(fibre.phase)});
  }
}

}  // namespace wale
