#include "geom/chart/knit_tile.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include "geom/chart/loop_curves.h"
#include "geom/error.h"
#include "geom/pattern_readers.h"
#include "geom/relax/relax_strains.h"
#include "geom/relax/resolution.h"
#include "geom/relax/starts.h"

namespace wale {
namespace {

// Loop lengths, in yarn diameters: shorter ones jam, longer ones are no cloth.
constexpr double kShortest = 6, kLongest = 100;
constexpr double kNanometres = 1e9;  // per metre
// A yarn that has to stretch by more, beside what is pulled at it, is jammed into a shape that is not that of its loop
// length.
constexpr double kJammed = 0.03;
// Of yarns that the chart gives no colour.
constexpr std::array<std::array<uint8_t, 3>, 4> kColors = {
    {{29, 63, 114}, {239, 227, 200}, {140, 47, 38}, {74, 107, 66}}};

void require(double value, double least, double most, const char* what, const char* unit, double per_unit) {
  if (!(value >= least && value <= most))
    user_error("{} of {:g}{}; valid: {:g} to {:g}{}", what, value * per_unit, unit, least * per_unit, most * per_unit,
               unit);
}

void check(const KnitSettings& s) {
  require(s.yarn_thickness, 1e-5, 0.1, "a yarn thickness", " mm", 1e3);
  if (s.loop_length != 0)
    require(s.loop_length / s.yarn_thickness, kShortest, kLongest, "a loop length", " yarn diameters", 1);
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
  if (s.wales && s.courses) user_error("one loop length gives both wales and courses; ask for one of them");
  if (s.loop_length != 0 && (s.wales || s.courses)) user_error("the loop length gives the gauge; ask for one of them");
}

double rounded(double metres) { return std::round(metres * kNanometres) / kNanometres; }
dvec3 rounded(const dvec3& p) { return {rounded(p.x), rounded(p.y), rounded(p.z)}; }

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
    for (dvec3& p : points) p = rounded(p);
    points.push_back(rounded(points.front() + dvec3(dvec2(yarns.yarns[y].shift) * pattern.period, 0)));
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

unsigned threads_of(const KnitSettings& settings) {
  return settings.threads ? settings.threads : std::max(1u, std::thread::hardware_concurrency());
}

void add_strains(KnittedTile& tile, const KnitSettings& settings, std::chrono::steady_clock::time_point until,
                 const std::function<bool(double)>& progress) {
  const std::vector<double> strains(std::begin(kStrains), std::end(kStrains));
  RelaxSettings relaxing;
  relaxing.max_steps = settings.max_steps;
  relaxing.until = until;
  RelaxedStrains found = relax_strains(tile.yarns, relaxing, strains, strains, threads_of(settings), progress);
  tile.stopped = found.stopped;
  if (tile.stopped) return;
  for (size_t i = 0; i < found.reached.size() && !tile.strain_missed; ++i)
    if (!found.reached[i].converged)
      tile.strain_missed = dvec2(strains[i % strains.size()], strains[i / strains.size()]),
      tile.relaxed = found.reached[i];
  for (auto& shape : found.table.offsets)
    for (dvec3& p : shape) p = rounded(p);
  tile.pattern.strains = std::move(found.table);
}

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
  yarns = refined(yarns);
  return relax(yarns, settings, progress);
}

KnittedTile knit_once(const StitchChart& chart, const Knit& knit, const KnitSettings& settings, double diameters,
                      const std::function<bool(double)>& progress) {
  constexpr double kFirstShare = 0.8;  // of the work; then comes the finer pass
  KnittedTile out;
  PeriodicYarns yarns = loop_curves(knit, {0.5 * settings.yarn_thickness, diameters, settings.step});
  RelaxSettings relaxing;
  relaxing.tension = settings.tension + settings.blocking * dvec2(knit.rows, knit.wales);
  relaxing.max_steps = settings.max_steps;
  relaxing.max_seconds = settings.max_seconds;
  relaxing.until = end_of(relaxing);
  if (settings.period) {
    refuse_beyond_yarn(yarns, *settings.period);
    const dvec2 stretch = *settings.period / yarns.period;
    for (dvec3& p : yarns.points) p *= dvec3(stretch, 1);
    yarns.period = *settings.period;
    relaxing.free_period_x = relaxing.free_period_y = false;
  } else {
    relaxing.most_strain = kJammed + std::max(relaxing.tension.x, relaxing.tension.y) / relaxing.stretch_stiffness;
  }
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
    out.relaxed = relax_finer(yarns, relaxing, [&](double, double) { return go_on(1); });
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

// Where a gauge may be reached, from loop lengths that were tried: between the nearest ones on both sides of it, else
// on along the slope of the two nearest, else in proportion, as a stitch grows with its loop.
double next_length(std::vector<dvec2> tried, double wanted) {  // (loop length, gauge)
  constexpr double kFlattest = -0.15, kSteepest = -2, kFarthest = 0.5;
  for (dvec2& t : tried) t = {std::log(t.x), std::log(t.y / wanted)};
  std::sort(tried.begin(), tried.end(), [](const dvec2& a, const dvec2& b) { return std::abs(a.y) < std::abs(b.y); });
  const dvec2 near = tried[0];
  for (const dvec2& t : tried)
    if (t.y * near.y < 0) return std::exp(near.x - near.y * (t.x - near.x) / (t.y - near.y));
  const double slope = tried.size() > 1 ? (tried[1].y - near.y) / (tried[1].x - near.x) : -1;
  return std::exp(near.x - std::clamp(near.y / std::clamp(slope, kSteepest, kFlattest), -kFarthest, kFarthest));
}

// Where a loop jams it was too short. From one start, as the search is for the loop's length.
KnittedTile knit_to_gauge(const StitchChart& chart, const Knit& knit, const KnitSettings& settings,
                          const std::function<bool(double)>& progress) {
  constexpr int kTries = 10;
  constexpr double kBracket = 1.02;
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double>(settings.max_seconds);
  const int axis = settings.wales ? 0 : 1;
  const double wanted = settings.wales ? *settings.wales : *settings.courses;
  const auto miss = [&](const KnittedTile& tile) { return std::abs(tile.gauge[axis] / wanted - 1); };
  double length = kPlainLoop, jams = 0;
  std::vector<dvec2> tried;
  std::optional<KnittedTile> best;
  KnitSettings rest = settings;
  rest.starts = 1;
  int tries = 0;
  while (tries < kTries) {
    if (tries > 0) rest.max_seconds = std::chrono::duration<double>(end - Clock::now()).count();
    if (rest.max_seconds <= 0) break;
    KnittedTile tile = knit_once(chart, knit, rest, length,
                                 [&](double share) { return !progress || progress((tries + share) / kTries); });
    ++tries;
    if (tile.stopped) {
      tile.tries = tries;
      return tile;
    }
    double next = 1.3 * length;
    if (!tile.relaxed.converged) {
      jams = std::max(jams, length);
      if (!tried.empty()) next = 0.5 * (length + best->loop_length / settings.yarn_thickness);
      if (!best) best = std::move(tile);
    } else {
      tried.emplace_back(length, tile.gauge[axis]);
      if (tried.size() == 1 || miss(tile) < miss(*best)) best = std::move(tile);
      if (miss(*best) <= kGaugeTolerance) break;
      next = next_length(tried, wanted);
    }
    next = std::clamp(next, std::max(kShortest, jams), kLongest);
    // Where the loop would be one that jams, the shortest that does not is looked for, until the two are near.
    double shortest = kLongest;
    for (const dvec2& t : tried) shortest = std::min(shortest, t.x);
    if (next < kBracket * jams && !tried.empty()) next = std::sqrt(jams * shortest);
    if (std::abs(next / length - 1) < 1e-4 || (!tried.empty() && next < kBracket * jams)) break;
    length = next;
  }
  best->tries = tries;
  best->gauge_reached = best->relaxed.converged && miss(*best) <= kGaugeTolerance;
  return std::move(*best);
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
  const double diameters = settings.loop_length > 0 ? settings.loop_length / settings.yarn_thickness : kPlainLoop;
  KnittedTile tile = settings.wales || settings.courses ? knit_to_gauge(chart, knit, settings, first)
                                                        : knit_once(chart, knit, settings, diameters, first);
  if (settings.strains && tile.relaxed.converged && tile.gauge_reached && !tile.stopped)
    add_strains(tile, settings, until,
                [&](double share) { return !progress || progress(kTileShare + (1 - kTileShare) * share); });
  return tile;
}

}  // namespace wale
