#include "geom/chart/knit_once.h"

#include <algorithm>
#include <cmath>
#include <thread>

#include "geom/chart/loop_curves.h"
#include "geom/error.h"
#include "geom/pattern_readers.h"
#include "geom/relax/resolution.h"
#include "geom/relax/starts.h"

namespace wale {
namespace {

constexpr double kNanometres = 1e9;  // per metre
// A yarn that has to stretch by more, beside what is pulled at it, is jammed into a shape that is not that of its loop
// length. The first pass is let through with twice as much: where yarns jam, its coarse polylines stretch by half as
// much again as the finer ones, up to twice (stockinette: 3.3 % and 1.6 %, 4.8 % and 3.2 %).
constexpr double kJammed = 0.03, kFirstJammed = 2 * kJammed;
// Of yarns that the chart gives no colour.
constexpr std::array<std::array<uint8_t, 3>, 4> kColors = {
    {{29, 63, 114}, {239, 227, 200}, {140, 47, 38}, {74, 107, 66}}};

double rounded(double metres) { return std::round(metres * kNanometres) / kNanometres; }

std::vector<std::array<uint8_t, 3>> palette_of(const StitchChart& chart) {
  if (chart.yarns.size() == 1 && !chart.yarns[0].color) return {};
  std::vector<std::array<uint8_t, 3>> palette;
  for (size_t i = 0; i < chart.yarns.size(); ++i)
    palette.push_back(chart.yarns[i].color.value_or(kColors[i % kColors.size()]));
  return palette;
}

Pattern pattern_of(const StitchChart& chart, const Knit& knit, const PeriodicYarns& yarns) {
  Pattern pattern;
  pattern.name = chart.name;
  pattern.period = {rounded(yarns.period.x), rounded(yarns.period.y)};
  pattern.yarn_radius = yarns.radius;
  pattern.stitches = {knit.wales, knit.rows};
  pattern.palette = palette_of(chart);
  pattern.chart = chart_lines(chart);
  for (size_t y = 0; y < yarns.yarns.size(); ++y) {
    const PeriodicYarn& yarn = yarns.yarns[y];
    PatternCurve curve;
    curve.yarn = knit.courses[y].yarn;
    curve.points.assign(yarns.points.begin() + yarn.first, yarns.points.begin() + yarn.first + yarn.count);
    pattern.curves.push_back(std::move(curve));
  }
  recentre_z(pattern);
  for (size_t y = 0; y < yarns.yarns.size(); ++y) {
    auto& points = pattern.curves[y].points;
    for (dvec3& p : points) p = rounded_to_nanometres(p);
    points.push_back(rounded_to_nanometres(points.front() + dvec3(dvec2(yarns.yarns[y].shift) * pattern.period, 0)));
  }
  return pattern;
}

// How far the relaxation has come: first the yarn swells, then the forces fall.
class Share {
 public:
  explicit Share(double wanted) : wanted_(wanted) {}
  double operator()(double thickness, double force) {
    if (thickness < 1) return at_ = std::max(at_, 0.6 * thickness);
    if (start_ == 0) start_ = std::max(force, 2 * wanted_);
    const double left = std::log(std::max(force, wanted_) / wanted_) / std::log(start_ / wanted_);
    return at_ = std::max(at_, 1 - 0.4 * std::min(left, 1.0));
  }

 private:
  double wanted_, start_ = 0, at_ = 0;
};

// A row's yarn crosses the tile, and a loop goes up and comes down again.
void refuse_beyond_yarn(const PeriodicYarns& yarns, const dvec2& period) {
  double shortest = INFINITY, all = 0;
  for (const PeriodicYarn& yarn : yarns.yarns) shortest = std::min(shortest, yarn.length), all += yarn.length;
  const dvec2 most(shortest, 0.5 * all);
  if (period.x > most.x || period.y > most.y)
    user_error("a period of {:g} x {:g} mm: the yarn of this loop length does not reach; valid: up to {:g} x {:g} mm",
               1e3 * period.x, 1e3 * period.y, 1e3 * most.x, 1e3 * most.y);
}

// The curves through the points are what is drawn, and where they bend they run outside of the polyline that was
// relaxed: by 7 % of the yarn's diameter at its tightest bends and 0.6 D a segment. With segments half as long it is a
// quarter of that, and the yarns that are seen keep their distance too.
Relaxed relax_finer(PeriodicYarns& yarns, RelaxSettings settings, const std::function<bool(double, double)>& progress) {
  settings.coarse_first = false;
  settings.contact_samples /= 2;  // as many along the yarn
  if (settings.watch) settings.watch(settings.path, in_diameters(yarns));
  yarns = refined(yarns);
  return relax(yarns, settings, progress);
}

}  // namespace

double loop_diameters_of(const KnitSettings& settings) {
  return settings.loop_length > 0 ? settings.loop_length / settings.yarn_thickness : kPlainLoop;
}

unsigned threads_of(const KnitSettings& settings) {
  return settings.threads ? settings.threads : std::max(1u, std::thread::hardware_concurrency());
}

RelaxSettings strain_settings(const KnitSettings& settings, std::chrono::steady_clock::time_point until) {
  RelaxSettings out;
  out.max_steps = settings.max_steps;
  out.max_seconds = settings.max_seconds;
  out.until = until;
  out.watch = settings.watch;
  out.path = size_t(settings.starts) + 1;
  return out;
}

dvec3 rounded_to_nanometres(const dvec3& p) { return {rounded(p.x), rounded(p.y), rounded(p.z)}; }

KnittedTile knit_once(const StitchChart& chart, const Knit& knit, const KnitSettings& settings, double diameters,
                      const std::function<bool(double)>& progress) {
  constexpr double kFirstShare = 0.5;  // of the work; then comes the finer pass
  KnittedTile out;
  PeriodicYarns yarns = loop_curves(knit, {0.5 * settings.yarn_thickness, diameters, settings.step});
  RelaxSettings relaxing;
  relaxing.tension = settings.tension + settings.blocking * dvec2(knit.rows, knit.wales);
  relaxing.max_steps = settings.max_steps;
  relaxing.max_seconds = settings.max_seconds;
  relaxing.watch = settings.watch;
  relaxing.until = end_of(relaxing);
  double pulled = 0;  // strain of the yarn by tension alone
  if (settings.period) {
    refuse_beyond_yarn(yarns, *settings.period);
    const dvec2 stretch = *settings.period / yarns.period;
    for (dvec3& p : yarns.points) p *= dvec3(stretch, 1);
    yarns.period = *settings.period;
    relaxing.free_period_x = relaxing.free_period_y = false;
  } else {
    // What one row and one wale are pulled by: a tile of more of them holds as many more yarns.
    const dvec2 pull = relaxing.tension / dvec2(knit.rows, knit.wales);
    pulled = std::max(pull.x, pull.y) / relaxing.stretch_stiffness;
  }
  relaxing.most_strain = kFirstJammed + pulled;
  std::vector<Share> shares(size_t(settings.starts), Share(relaxing.force_tolerance));
  std::vector<double> done(shares.size(), 0);
  const auto go_on = [&](double share) {
    out.stopped = out.stopped || (progress && !progress(share));
    return !out.stopped;
  };
  out.relaxed = relax_from_starts(yarns, relaxing, settings.starts, threads_of(settings),
                                  [&](int start, double thickness, double f) {
                                    done[size_t(start)] = shares[size_t(start)](thickness, f);
                                    double sum = 0;
                                    for (const double d : done) sum += d;
                                    return go_on(kFirstShare * sum / double(done.size()));
                                  });
  if (out.relaxed.converged) {
    const int steps = out.relaxed.steps;
    relaxing.max_steps -= steps;
    relaxing.path = size_t(settings.starts);
    relaxing.most_strain = kJammed + pulled;
    Share finer(relaxing.force_tolerance);
    out.relaxed = relax_finer(yarns, relaxing, [&](double thickness, double force) {
      return go_on(kFirstShare + (1 - kFirstShare) * finer(thickness, force));
    });
    out.relaxed.steps += steps;
  }
  if (out.stopped) out.relaxed.converged = false;
  out.loop_length = diameters * settings.yarn_thickness;
  out.force_wanted = relaxing.force_tolerance;
  out.gauge = dvec2(knit.wales, knit.rows) / yarns.period;
  out.pattern = pattern_of(chart, knit, yarns);
  out.pattern.settings = {{"yarn_thickness", settings.yarn_thickness},
                          {"loop_length", out.loop_length},
                          {"step", settings.step},
                          {"course_tension", settings.tension.x},
                          {"wale_tension", settings.tension.y},
                          {"blocking", settings.blocking},
                          {"starts", settings.starts}};
  out.yarns = std::move(yarns);
  if (settings.period) {
    out.pattern.settings.emplace_back("period_x", settings.period->x);
    out.pattern.settings.emplace_back("period_y", settings.period->y);
  }
  return out;
}

}  // namespace wale
