#include "geom/chart/knit_tile.h"

#include <chrono>

#include "geom/chart/gauge_search.h"
#include "geom/chart/knit_once.h"
#include "geom/error.h"
#include "geom/relax/relax_strains.h"

namespace wale {
namespace {

void require(double value, double least, double most, const char* what, const char* unit, double per_unit) {
  if (!(value >= least && value <= most))
    user_error("{} of {:g}{}; valid: {:g} to {:g}{}", what, value * per_unit, unit, least * per_unit, most * per_unit,
               unit);
}

void check(const KnitSettings& s) {
  require(s.yarn_thickness, 1e-5, 0.1, "a yarn thickness", " mm", 1e3);
  if (s.loop_length != 0)
    require(s.loop_length / s.yarn_thickness, kShortestLoop, kLongestLoop, "a loop length", " yarn diameters", 1);
  require(s.step, 0.2, 1.5, "a resolution", " yarn diameters", 1);
  for (const double t : {s.tension.x, s.tension.y}) require(t, 0, 1000, "a tension", "", 1);
  require(s.blocking, 0, 10, "a blocking", "", 1);
  require(s.starts, 1, 64, "a number of starts", "", 1);
  require(s.max_seconds, 1e-3, 1e6, "a time", " s", 1);
  if (s.period)
    for (const double p : {s.period->x, s.period->y})
      require(p / s.yarn_thickness, 0.5, 1e5, "a period", " yarn diameters", 1);
  for (const auto& gauge : {s.wales, s.courses})
    if (gauge) require(*gauge * s.yarn_thickness, 1e-3, 2, "a gauge", " stitches per yarn diameter", 1);
  if (s.period && (s.wales || s.courses)) user_error("a period that is held has its gauge; give one of them");
  if (s.period && (s.tension != dvec2(0.0) || s.blocking != 0))
    user_error("a period that is held is not pulled at; leave it out, or blocking and tension");
  if (s.wales && s.courses) user_error("one loop length gives both wales and courses; ask for one of them");
  if (s.loop_length != 0 && (s.wales || s.courses)) user_error("the loop length gives the gauge; ask for one of them");
}

void add_strains(KnittedTile& tile, const KnitSettings& settings, std::chrono::steady_clock::time_point until,
                 const std::function<bool(double)>& progress) {
  const std::vector<double> strains(std::begin(kStrains), std::end(kStrains));
  RelaxedStrains found =
      relax_strains(tile.yarns, strain_settings(settings, until), strains, strains, threads_of(settings), progress);
  tile.stopped = found.stopped;
  if (tile.stopped) return;
  for (size_t i = 0; i < found.reached.size() && !tile.strain_missed; ++i)
    if (!found.reached[i].converged)
      tile.strain_missed = dvec2(strains[i % strains.size()], strains[i / strains.size()]),
      tile.relaxed = found.reached[i];
  for (auto& shape : found.table.offsets)
    for (dvec3& p : shape) p = rounded_to_nanometres(p);
  tile.pattern.strains = std::move(found.table);
}

}  // namespace

KnittedTile knit_tile(const StitchChart& chart, const KnitSettings& settings,
                      const std::function<bool(double)>& progress) {
  constexpr double kTileShare = 0.3;  // of the work, where strains follow
  check(settings);
  RelaxSettings all;
  all.max_seconds = settings.max_seconds;
  const auto until = end_of(all);
  const Knit knit = knit_chart(chart);
  const auto first = [&](double share) { return !progress || progress(settings.strains ? kTileShare * share : share); };
  KnittedTile tile = settings.wales || settings.courses
                         ? knit_to_gauge(
                               settings,
                               [&](double diameters, const KnitSettings& own, const auto& share) {
                                 return knit_once(chart, knit, own, diameters, share);
                               },
                               first)
                         : knit_once(chart, knit, settings, loop_diameters_of(settings), first);
  if (settings.strains && tile.relaxed.converged && tile.gauge_end == GaugeEnd::reached && !tile.stopped)
    add_strains(tile, settings, until,
                [&](double share) { return !progress || progress(kTileShare + (1 - kTileShare) * share); });
  return tile;
}

}  // namespace wale
