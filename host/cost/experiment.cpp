#include "host/cost/experiment.h"

#include <algorithm>

#include "geom/error.h"
#include "host/device_fault.h"
#include "host/film.h"
#include "host/progress.h"
#include "host/stop.h"

namespace wale::cost {
namespace {

constexpr int kSurveySamples = int(kScrambles);
constexpr unsigned kSurveySeed = 0x5eed0000u, kFirstSeed = 0x57a1e000u;  // not the seeds that scenes have
constexpr int kHitSeeds = 4;  // jittered rays a pixel whose hits are compared

// Shares of the time: for the first pass, for the first pass of one unit, and what is kept for pictures and files.
constexpr double kSurveyShare = 0.6, kUnitShare = 0.2, kWritingShare = 0.03;

// Bytes on the device, and as many on the host, of a segment that is traced and shaded.
constexpr double kSegmentBytes = 48;

// Of a pixel of a repetition: its colour and its variance.
constexpr double kPictureBytes = 6 * sizeof(float);

double segments_of(const Scene& scene, const Loaders& loaders) {
  double sum = 0;
  for (const FabricScene& fabric : scene.fabrics) {
    BaseMesh mesh = load_mesh(fabric.mesh, loaders);
    transform_mesh(mesh, fabric.transform);
    sum += double(estimate_segments(mesh, load_pattern(fabric.pattern), fabric.spec));
  }
  return sum;
}

}  // namespace

Experiment::Experiment(const Device& device, const Loaders& loaders, Levels levels, std::optional<GivenReference> given,
                       double seconds, Clock clock, std::filesystem::path kernel_dir)
    : device_(device),
      loaders_(loaders),
      levels_(std::move(levels)),
      given_(std::move(given)),
      seconds_(seconds),
      clock_(std::move(clock)),
      scenes_(device, loaders, memory_to_use(device.traits()), std::move(kernel_dir)),
      measured_(levels_.units.size()) {
  for (size_t u = 0; u < measured_.size(); ++u) measured_[u].price.needed = needed(u);
}

void Experiment::leave_out(size_t u, std::string why) {
  measured_[u].result.left_out = std::move(why);
  scenes_.forget(levels_.units[u]);
}

// Why its geometry will not be built; empty: it will.
std::string Experiment::too_large(const Unit& unit) const {
  const double segments = segments_of(unit.scene, loaders_), bytes = kSegmentBytes * segments;
  if (const double most = double(memory_to_use(device_.traits())); bytes > most)
    return fmt::format("needs about {:.1f} GB on the device, of {:.1f} GB that may be used", 1e-9 * bytes, 1e-9 * most);
  const double at_base = segments_of(levels_.units[0].scene, loaders_);
  const double start = at_base > 0 ? measured_[0].result.start.geometry() * segments / at_base : 0;
  if (start > kUnitShare * seconds_)
    return fmt::format("would take about {} before its first ray; give more --minutes", duration_text(start));
  return {};
}

void Experiment::measure_geometry(size_t u) {
  const Unit& unit = levels_.units[u];
  if (!surface_ || unit.geometry == levels_.units[levels_.reference].geometry) return;
  double largest = 0;
  for (unsigned i = 0; i < kHitSeeds; ++i)
    for (const dvec3& hit : scenes_.first_hits(unit, kSurveySeed + i))
      if (!surface_->near_open_end(hit)) largest = std::max(largest, surface_->radii_from(hit));
  measured_[u].result.radii = largest;
}

// What "auto" came to for the scene as it is holds for all of its levels: finer curves may be so many that they would
// be held procedurally, and be other geometry.
void Experiment::keep_storage(Scene& scene) {
  const auto base = scenes_.prepare(levels_.units[0]);
  for (size_t i = 0; i < scene.fabrics.size(); ++i)
    if (Storage& storage = scene.fabrics[i].spec.storage; storage == Storage::automatic)
      storage = base->world.fabrics[i].procedural ? Storage::procedural : Storage::stored;
}

// Lattices knit whole repeats from the corner of the UVs on: where the cloth's are none, stitches are larger, smaller
// or elsewhere, and pictures of them cannot be compared. Empty: they are those of the scene.
std::string Experiment::other_stitches(const Prepared& geometry) {
  const auto base = scenes_.prepare(levels_.units[0]);
  constexpr double kSame = 1e-3;
  for (size_t i = 0; i < base->world.fabrics.size(); ++i) {
    const Fabric::Report &scene = base->world.fabrics[i].report, &own = geometry.world.fabrics[i].report;
    const std::string& name = base->world.fabrics[i].name;
    const dvec2 there = scene.tile_metres, here = own.tile_metres;
    if (glm::length(here / there - 1.0) > kSame)
      return fmt::format(
          "it knits whole tiles of {:.4g} x {:.4g} mm over fabric \"{}\" instead of {:.4g} x {:.4g}: "
          "other stitches, another picture; give whole \"repeats\" to compare it",
          1e3 * here.x, 1e3 * here.y, name, 1e3 * there.x, 1e3 * there.y);
    for (size_t c = 0; c < std::min(scene.tile_phase.size(), own.tile_phase.size()); ++c) {
      const dvec2 moved = own.tile_phase[c] - scene.tile_phase[c];
      if (glm::length(moved - glm::round(moved)) > kSame)
        return fmt::format(
            "its tiles lie {:.2g} x {:.2g} tiles from those of the scene on fabric \"{}\": another picture; a cloth "
            "whose UVs begin at a whole tile can be compared",
            std::abs(moved.x), std::abs(moved.y), name);
    }
  }
  return {};
}

// False when it was stopped.
bool Experiment::survey_unit(size_t u) {
  const Unit& unit = levels_.units[u];
  Measured& m = measured_[u];
  const double begun = clock_();
  const auto geometry = scenes_.prepare(unit);
  const double built = clock_() - begun;
  m.result.start = geometry->start;
  if (const std::string why = other_stitches(*geometry); !why.empty()) {
    cannot_render(u, why);
    return true;
  }
  if (u == levels_.reference) {
    surface_ = ply_surface_of(device_, geometry->world);
    measure_geometry(0);  // the scene itself came before
  }
  measure_geometry(u);
  // The first render compiles: some drivers make machine code when a kernel is launched.
  const double before = clock_();
  const Repetition first = scenes_.render_once(unit, kSurveySamples, kSurveySeed);
  const double took = clock_() - before;
  if (!first.complete) return false;
  const Repetition second = scenes_.render_once(unit, kSurveySamples, kSurveySeed + 1);
  if (!second.complete) return false;
  m.result.start.programs = std::max(0.0, took - second.wall);
  if (second.nan_samples || first.nan_samples)
    bug("cost: {}: {} samples were not finite", unit.name, second.nan_samples + first.nan_samples);
  m.price.seconds_per_sample = second.wall / kSurveySamples;
  m.price.seconds_per_visit = scenes_.keeps(unit) ? 0 : built;
  return true;
}

void Experiment::survey(const Tell& tell) {
  std::vector<size_t> order = {0};
  if (levels_.reference != 0) order.push_back(levels_.reference);
  // Presets next: if the time does not allow all levels, these are the last to go.
  for (const bool presets : {true, false})
    for (const Level& row : levels_.rows)
      if (row.unit && (row.option == "preset") == presets &&
          std::find(order.begin(), order.end(), *row.unit) == order.end())
        order.push_back(*row.unit);
  for (size_t k = 0; k < order.size(); ++k) {
    const size_t u = order[k];
    const Unit& unit = levels_.units[u];
    tell(unit.name, double(k) / double(order.size()));
    if (!ended_.empty() || stop_requested()) {
      ended_ = "stopped";
      leave_out(u, "stopped before it was rendered");
      continue;
    }
    if (!needed(u) && clock_() > kSurveyShare * seconds_) {
      leave_out(u, "the first pass over the levels before it took too long; give more --minutes");
      continue;
    }
    try {
      if (u != 0) keep_storage(levels_.units[u].scene);
      // Of a given reference's own level the geometry alone is wanted, unless it has a row.
      const auto has_row = [&](const Level& row) { return row.unit == u; };
      if (u == levels_.reference && given_ && std::none_of(levels_.rows.begin(), levels_.rows.end(), has_row)) {
        surface_ = ply_surface_of(device_, scenes_.prepare(unit)->world);
        measure_geometry(0);
        leave_out(u, "no level");
        continue;
      }
      if (!needed(u) && !scenes_.keeps(unit))
        if (const std::string why = too_large(unit); !why.empty()) {
          leave_out(u, why);
          continue;
        }
      if (!survey_unit(u)) {
        ended_ = "stopped";
        leave_out(u, "stopped before it was rendered");
      }
    } catch (const Error& error) {
      if (error.fault() == Fault::bug || u == 0) throw;
      cannot_render(u, error.what());
    } catch (const cl::Error& error) {
      if (u == 0) throw;
      cannot_render(u, opencl_fault(error));
    }
  }
}

// A level may have no room where the scene itself has, or ask the device for what it does not do. So may the reference,
// whose part the scene then takes.
void Experiment::cannot_render(size_t u, const std::string& why) {
  leave_out(u, why);
  if (!needed(u)) return;
  reference_note_ = fmt::format("the scene itself, as a more accurate one cannot be held ({}): ", why);
  levels_.reference = 0;
  surface_ = ply_surface_of(device_, scenes_.prepare(levels_.units[0])->world);
}

void Experiment::measure(const Tell& tell) {
  if (!ended_.empty()) return;
  std::vector<size_t> units;
  std::vector<UnitPrice> prices;
  // The reference comes before those that are compared with it, the base before all.
  for (size_t u = 0; u < measured_.size(); ++u)
    if (measured_[u].result.left_out.empty()) units.push_back(u);
  std::stable_partition(units.begin(), units.end(), [&](size_t u) { return u == 0 || u == levels_.reference; });
  for (const size_t u : units) prices.push_back(measured_[u].price);
  const FilmScene& film = levels_.units[0].scene.film;
  const double bytes = kPictureBytes * double(units.size()) * film.width * film.height;
  const int most = int(std::min(double(memory_to_use(device_.traits())) / bytes, double(kMostRepetitions)));
  if (most < kFewestRepetitions)
    user_error("--size {}x{}: pictures of {} repetitions of {} levels do not fit into memory; give a smaller --size",
               film.width, film.height, kFewestRepetitions, units.size());
  const double time = left() - kWritingShare * seconds_;
  const RunPlan plan = plan_runs(prices, time, most);
  if (plan.repetitions == 0)
    user_error(
        "--minutes {:.3g}: {} of them are left after the first pass, and the scene and its reference alone need "
        "{}; give more, or a smaller --size",
        seconds_ / 60, duration_text(std::max(0.0, time)), duration_text(least_seconds(prices)));
  for (size_t k = 0; k < units.size(); ++k)
    if (plan.samples[k] == 0)
      leave_out(units[k], fmt::format("{} repetitions of {} samples would take {}; give more --minutes",
                                      kFewestRepetitions, kScrambles,
                                      duration_text(kFewestRepetitions * (kScrambles * prices[k].seconds_per_sample +
                                                                          prices[k].seconds_per_visit))));
  const double begun = clock_(), deadline = seconds_ - kWritingShare * seconds_;
  const bool done = run_interleaved(plan, deadline, clock_, [&](size_t k, int repetition, int samples) {
    const size_t u = units[k];
    tell(levels_.units[u].name, (clock_() - begun) / std::max(1e-9, deadline - begun));
    if (stop_requested()) return false;
    Repetition r = scenes_.render_once(levels_.units[u], samples, kFirstSeed + unsigned(repetition));
    if (!r.complete) return false;
    if (r.nan_samples) bug("cost: {}: {} samples were not finite", levels_.units[u].name, r.nan_samples);
    measured_[u].result.samples = samples;
    measured_[u].repetitions.push_back(std::move(r));
    return true;
  });
  if (!done) ended_ = stop_requested() ? "stopped" : "the last repetitions took longer than planned";
}

}  // namespace wale::cost
