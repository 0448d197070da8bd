#include "geom/relax/relax_strains.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <span>

#include "geom/error.h"
#include "geom/relax/step_bound.h"
#include "geom/run_tasks.h"

namespace wale {
namespace {

// A yarn under tension is pressed flat where it crosses another. In the published table of stockinette (MADYPG, Sperl
// et al. 2021) the least distance of centrelines falls from 0.94 D to 0.81 D at +50 % along the course and 0.63 D at
// +100 %; a yarn that keeps 0.95 D would have to stretch 1.9 times as much. The stiffness is
// fitted to the published length of the yarn at +100 % along the wale, and to nothing else (bench/results/strain.md).
// With a stiffness that is fitted anew for each, least distances of 0.1, 0.2, 0.3 and 0.4 D leave the other published
// lengths 6.9, 7.5, 9.4 and 11.8 % off (rms); at 0.05 and 0.5 D some shapes do not come to rest.
constexpr double kCrushed = 0.2, kCrushStiffness = 1200;

size_t zero_of(const std::vector<double>& strains, const char* along) {
  for (size_t i = 0; i < strains.size(); ++i)
    if (!std::isfinite(strains[i]) || strains[i] <= -1 || (i > 0 && strains[i] <= strains[i - 1]))
      user_error("strains along the {}: ascending numbers above -1 are needed", along);
  const auto found = std::find(strains.begin(), strains.end(), 0.0);
  if (found == strains.end()) user_error("strains along the {}: 0 must be one of them", along);
  return size_t(found - strains.begin());
}

// Brings the period to that of the strain in affine steps that let no yarn pass another; as far as that goes,
// and as long as `go_on` says so.
void strain_tile(PeriodicYarns& yarns, const dvec2& period, const RelaxSettings& settings,
                 const std::function<bool()>& go_on) {
  constexpr int kSteps = 100;
  const double reach = 4 * yarns.radius;
  const std::vector<YarnSegment> segments = segments_of(yarns);
  for (int i = 0; i < kSteps && std::chrono::steady_clock::now() < settings.until && go_on(); ++i) {
    TileStep step;
    step.points.assign(yarns.points.size(), dvec3(0.0));
    step.strain = period / yarns.period - 1.0;
    const auto near = near_pairs(yarns, segments, reach, settings.neighbours * 2 * yarns.radius);
    const double share = safe_share(yarns, segments, near, reach, 0, step);
    yarns = moved(yarns, step, share);
    if (settings.watch) settings.watch(settings.path, in_diameters(yarns));
    if (share < 1) continue;
    yarns.period = period;
    return;
  }
}

}  // namespace

bool RelaxedStrains::converged() const {
  return std::all_of(reached.begin(), reached.end(), [](const Relaxed& r) { return r.converged; });
}

RelaxedStrains relax_strains(const PeriodicYarns& relaxed, const RelaxSettings& settings, std::vector<double> course,
                             std::vector<double> wale, unsigned threads, const std::function<bool(double)>& progress) {
  const size_t zero_course = zero_of(course, "course"), zero_wale = zero_of(wale, "wale");
  const size_t columns = course.size();
  RelaxedStrains out;
  out.reached.resize(columns * wale.size());
  std::vector<PeriodicYarns> shapes(out.reached.size());
  RelaxSettings held = settings;
  held.free_period_x = held.free_period_y = held.coarse_first = false;
  held.until = end_of(settings);
  held.closest = kCrushed;
  held.contact_stiffness = kCrushStiffness;
  const auto node = [&](size_t ic, size_t iw) { return iw * columns + ic; };
  std::mutex telling;
  size_t done = 0;
  const auto go_on = [&](double, double) {
    const std::lock_guard lock(telling);
    out.stopped = out.stopped || (progress && !progress(double(done) / double(shapes.size())));
    return !out.stopped;
  };
  const auto go = [&](size_t ic, size_t iw, size_t from) {
    if (!go_on(0, 0)) return;
    PeriodicYarns& shape = shapes[node(ic, iw)] = shapes[from];
    const dvec2 strain(course[ic], wale[iw]);
    RelaxSettings own = held;
    own.path += node(ic, iw);
    if (own.watch) own.watch(own.path, in_diameters(shape));
    strain_tile(shape, relaxed.period * (1.0 + strain), own, [&] { return go_on(0, 0); });
    if (!go_on(0, 0)) return;
    out.reached[node(ic, iw)] = relax(shape, own, go_on);
    const std::lock_guard lock(telling);
    ++done;
  };
  shapes[node(zero_course, zero_wale)] = relaxed;
  Relaxed& middle = out.reached[node(zero_course, zero_wale)];
  RelaxSettings own = held;
  own.path += node(zero_course, zero_wale);
  middle = relax(shapes[node(zero_course, zero_wale)], own, go_on);
  ++done;
  const PeriodicYarns base = shapes[node(zero_course, zero_wale)];
  // Along the course at wale strain 0, then every column from there.
  for (size_t ic = zero_course + 1; ic < columns; ++ic) go(ic, zero_wale, node(ic - 1, zero_wale));
  for (size_t ic = zero_course; ic-- > 0;) go(ic, zero_wale, node(ic + 1, zero_wale));
  std::vector<size_t> open;
  for (size_t ic = 0; ic < columns; ++ic) open.push_back(ic);
  run_tasks(threads, open, [&](size_t ic, const auto&) {
    for (size_t iw = zero_wale + 1; iw < wale.size(); ++iw) go(ic, iw, node(ic, iw - 1));
    for (size_t iw = zero_wale; iw-- > 0;) go(ic, iw, node(ic, iw + 1));
  });
  if (out.stopped) return out;
  for (size_t iw = 0; iw < wale.size(); ++iw)
    for (size_t ic = 0; ic < columns; ++ic) {
      const PeriodicYarns& shape = shapes[node(ic, iw)];
      std::vector<dvec3> offset(shape.points.size());
      dvec3 mean(0.0);
      for (size_t i = 0; i < offset.size(); ++i) {
        offset[i] = shape.points[i] / dvec3(shape.period / relaxed.period, 1.0) - base.points[i];
        mean += offset[i] / double(offset.size());
      }
      std::vector<dvec3> curves;
      for (const PeriodicYarn& yarn : shape.yarns)
        for (uint32_t k = 0; k <= yarn.count; ++k) curves.push_back(offset[yarn.first + k % yarn.count] - mean);
      out.table.offsets.push_back(std::move(curves));
    }
  out.table.course = std::move(course);
  out.table.wale = std::move(wale);
  return out;
}

}  // namespace wale
