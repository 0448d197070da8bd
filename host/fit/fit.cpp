#include "host/fit/fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

#include "geom/error.h"
#include "host/fit/bobyqa.h"
#include "host/fit/residual_derivative.h"

namespace wale::fit {
namespace {

constexpr int kLooks = 4;                // places looked at for each start
constexpr double kMargin = 0.02;         // starts keep off the bounds, where derivatives are one-sided
constexpr double kUndetermined = 0.125;  // standard deviation, of the bounds: a range is four of them
constexpr double kAlike = 0.95;
constexpr double kLeastStep = 2e-3;
constexpr double kDescentShare = 0.6;  // of the time
constexpr int kLastShare = 4;
constexpr double kPolishShare = 0.9;
constexpr uint32_t kRoundSeeds = 1u << 16;  // far from those of descents

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

double radical_inverse(int base, int i) {
  double value = 0, digit = 1.0 / base;
  for (; i > 0; i /= base, digit /= base) value += digit * (i % base);
  return value;
}

int prime(size_t i) {
  int found = 2;
  for (size_t count = 0;; ++found) {
    bool is = true;
    for (int d = 2; d * d <= found; ++d) is &= found % d != 0;
    if (is && count++ == i) return found;
  }
}

// Point i of Halton's sequence in the box (Halton 1960).
std::vector<double> spread_place(size_t axes, int i) {
  std::vector<double> x(axes);
  for (size_t k = 0; k < axes; ++k) x[k] = kMargin + (1 - 2 * kMargin) * radical_inverse(prime(k), i);
  return x;
}

}  // namespace

Fit::Fit(const Scene& scene, LitPair& renderer, PairResiduals residuals, FitSettings settings)
    : scene_(scene), renderer_(renderer), residuals_(std::move(residuals)), settings_(std::move(settings)) {
  if (settings_.parameters.empty()) bug("fit: nothing to fit");
}

Residuals Fit::evaluate(std::span<const double> places, int samples, bool derivatives, uint32_t first_seed) {
  Scene scene = scene_;
  apply_parameters(scene, settings_.target, settings_.parameters, places);
  Residuals out;
  PicturePair mean;
  for (uint32_t half = 0; half < 2; ++half) {
    const uint32_t seed = first_seed + half;
    Replicate& replicate = out.replicates.emplace_back();
    if (!derivatives || settings_.method != FitMethod::paths) {
      add(mean, renderer_.render(scene, std::max(1, samples / 2), seed), replicate.values);
      continue;
    }
    const LitPair::WithGradients rendered = renderer_.render_with_gradients(scene, std::max(1, samples / 2), seed);
    add(mean, rendered.pictures, replicate.values);
    for (size_t k = 0; k < settings_.parameters.size(); ++k)
      replicate.derivatives.push_back(residual_derivative(residuals_, rendered, settings_.parameters[k], places[k]));
  }
  pictures_ = std::move(mean);
  return out;
}

void Fit::add(PicturePair& mean, const PicturePair& half, std::vector<double>& residuals) const {
  residuals = residuals_(half);
  for (const auto side : {&PicturePair::front, &PicturePair::back}) {
    Picture& to = mean.*side;
    if (to.count() == 0) to = Picture((half.*side).width, (half.*side).height);
    for (size_t i = 0; i < to.pixels.size(); ++i) to.pixels[i] += 0.5f * (half.*side).pixels[i];
  }
}

bool Fit::out_of_time(double share) const {
  return settings_.seconds > 0 && now() - begun_ > share * settings_.seconds;
}

void Fit::keep(FitJournal& journal, int start, std::span<const double> places, double loss) {
  // Losses of looking, of descents and of polishing have different samples.
  const int looking = -1, polishing = settings_.starts;
  if (start != best_start_ && (best_start_ == looking || start == polishing)) best_loss_ = INFINITY;
  best_start_ = start;
  const bool better = loss < best_loss_;
  if (better) best_loss_ = loss;
  journal.steps.push_back({start, now() - begun_, loss, {places.begin(), places.end()}});
  if (progress_) progress_({&journal, &pictures_, better});
}

std::vector<std::vector<double>> Fit::look_for_starts(FitJournal& journal) {
  std::vector<double> own = places_of(scene_, settings_.target, settings_.parameters);
  for (double& v : own) v = std::clamp(v, kMargin, 1 - kMargin);
  if (settings_.starts == 1) return {own};
  // The scene's own place is one of them; the others are the best of a few that are spread over the box.
  std::vector<std::pair<double, std::vector<double>>> seen;
  const int looks = std::max(4, settings_.samples / 4);
  for (int i = 1; i < settings_.starts * kLooks && !stop_() && !out_of_time(kDescentShare); ++i) {
    std::vector<double> x = spread_place(own.size(), i);
    const double loss = evaluate(x, looks, false, descent_seed()).loss();
    keep(journal, -1, x, loss);
    seen.emplace_back(loss, std::move(x));
  }
  std::stable_sort(seen.begin(), seen.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::vector<double>> chosen{own};
  for (size_t i = 0; i < seen.size() && chosen.size() < size_t(settings_.starts); ++i) chosen.push_back(seen[i].second);
  return chosen;
}

FitStart Fit::descend(FitJournal& journal, int number, const std::vector<double>& from) {
  FitStart out;
  out.from = from;
  const int samples = settings_.samples;
  // What an earlier run reached.
  std::vector<double> begin = from;
  double least = INFINITY;
  for (const FitStep& step : journal.steps) {
    if (step.start != number) continue;
    if (out.evaluations++ == 0) out.first_loss = step.loss;
    if (step.loss < least) least = step.loss, begin = step.places;
  }
  const int left = std::max(1, settings_.evaluations - out.evaluations);
  const auto note = [&](std::span<const double> x, double loss) {
    if (out.evaluations++ == 0) out.first_loss = loss;
    keep(journal, number, x, loss);
  };
  const std::function<bool()> ended = [this] { return stop_() || out_of_time(kDescentShare); };
  if (settings_.method == FitMethod::bobyqa) {
    const auto loss_at = [&](std::span<const double> x) {
      const double loss = evaluate(x, samples, false, descent_seed()).loss();
      note(x, loss);
      return loss;
    };
    const BobyqaResult r = bobyqa(loss_at, begin, left, kLeastStep, ended);
    // Where the time is over, NLopt knows of no place at all.
    const bool better = r.loss < least;
    out.to = better ? r.x : begin;
    out.loss = better ? r.loss : least;
    out.converged = r.converged;
    if (out.evaluations == 0) out.loss = loss_at(begin);
    return out;
  }
  LeastSquaresOptions options;
  options.evaluations = left;
  options.least_step = kLeastStep;
  options.stop = ended;
  const LeastSquaresResult r = least_squares(
      [&](std::span<const double> x, bool derivatives) { return evaluate(x, samples, derivatives, descent_seed()); },
      begin, options, [&](std::span<const double> x, double loss, bool) { note(x, loss); });
  out.to = r.x, out.loss = r.residuals.loss(), out.converged = r.converged;
  return out;
}

bool Fit::all_converged(const FitJournal& journal) const {
  return journal.finished.size() == size_t(settings_.starts) &&
         std::all_of(journal.finished.begin(), journal.finished.end(), [](const FitStart& s) { return s.converged; });
}

const FitStart& Fit::best_of(const FitJournal& journal) const {
  return *std::min_element(journal.finished.begin(), journal.finished.end(),
                           [](const FitStart& a, const FitStart& b) { return a.loss < b.loss; });
}

Replicate Fit::round(std::span<const double> places, int samples, uint32_t number) {
  const auto scene_at = [&](std::span<const double> at) {
    Scene scene = scene_;
    apply_parameters(scene, settings_.target, settings_.parameters, at);
    return scene;
  };
  const uint32_t seed = kRoundSeeds * settings_.seed + number;
  Replicate out;
  out.derivatives.resize(places.size());
  if (settings_.method == FitMethod::paths) {
    const LitPair::WithGradients rendered = renderer_.render_with_gradients(scene_at(places), samples, seed);
    pictures_ = rendered.pictures;
    for (size_t k = 0; k < places.size(); ++k)
      out.derivatives[k] = residual_derivative(residuals_, rendered, settings_.parameters[k], places[k]);
  } else {
    pictures_ = renderer_.render(scene_at(places), samples, seed);
  }
  out.values = residuals_(pictures_);
  // Central differences where paths do not tell, wide enough to stand above the noise. They weigh residuals, and
  // need not be as sure as those.
  constexpr double kWide = 0.05;
  const int fewer = std::max(1, samples / 2);
  for (size_t k = 0; k < places.size(); ++k) {
    if (!out.derivatives[k].empty()) continue;
    std::vector<double> lower(places.begin(), places.end()), upper = lower;
    lower[k] = std::max(0.0, places[k] - kWide);
    upper[k] = std::min(1.0, places[k] + kWide);
    const std::vector<double> a = residuals_(renderer_.render(scene_at(lower), fewer, seed));
    const std::vector<double> b = residuals_(renderer_.render(scene_at(upper), fewer, seed));
    for (size_t i = 0; i < a.size(); ++i) out.derivatives[k].push_back((b[i] - a[i]) / (upper[k] - lower[k]));
  }
  return out;
}

FitResult Fit::judge(const FitStart& best, const Polished& polished) {
  FitResult out;
  out.best = best;
  out.best.to = polished.x;
  out.polished = polished.converged;
  out.best.converged = best.converged && polished.converged;
  // Noise that neither descents nor rounds have seen.
  const uint32_t seed = kRoundSeeds * settings_.seed + kRoundSeeds / 2;
  const Residuals at = evaluate(polished.x, std::max(2, settings_.final_samples / kLastShare), false, seed);
  out.best.loss = at.loss();
  out.pictures = pictures_;
  // What a render of half the samples has of noise alone is half of the squared difference of two; the mean of both has
  // half of that.
  const std::vector<double>&first = at.replicates[0].values, &second = at.replicates[1].values;
  for (size_t i = 0; i < first.size(); ++i) out.render_noise += 0.25 * (first[i] - second[i]) * (first[i] - second[i]);

  out.alike = polished.errors.alike(kAlike);
  for (size_t k = 0; k < polished.x.size(); ++k) {
    const FitParameter& p = settings_.parameters[k];
    const double place = polished.x[k];
    FittedParameter fitted;
    fitted.value = p.value(place);
    fitted.start = p.value(best.from[k]);
    fitted.at_bound = place <= 1e-3 || place >= 1 - 1e-3;
    fitted.assessed = !polished.errors.too_few_cells;
    if (const auto deviation = polished.errors.deviations[k]) {
      fitted.low = p.value(std::max(0.0, place - 2 * *deviation));
      fitted.high = p.value(std::min(1.0, place + 2 * *deviation));
      fitted.determined = *deviation < kUndetermined;
    }
    out.parameters.push_back(fitted);
  }
  out.scene = scene_;
  apply_parameters(out.scene, settings_.target, settings_.parameters, polished.x);
  return out;
}

std::optional<FitResult> Fit::run(FitJournal& journal, const std::function<bool()>& stop,
                                  const std::function<void(const FitProgress&)>& progress) {
  try {
    return whole_run(journal, stop, progress);
  } catch (const Stopped&) {
    journal.seconds = now() - begun_;
    return std::nullopt;
  }
}

std::optional<FitResult> Fit::whole_run(FitJournal& journal, const std::function<bool()>& stop,
                                        const std::function<void(const FitProgress&)>& progress) {
  stop_ = stop;
  progress_ = progress;
  begun_ = now() - journal.seconds;
  const auto stopped = [&] {
    journal.seconds = now() - begun_;
    return stop_();
  };
  if (journal.chosen.empty()) {
    std::vector<std::vector<double>> chosen = look_for_starts(journal);
    if (stopped()) return std::nullopt;
    journal.chosen = std::move(chosen);
  }
  for (size_t i = 0; i < journal.chosen.size() && (i == 0 || !out_of_time(kDescentShare)); ++i) {
    const bool done = i < journal.finished.size();
    // An earlier run may have had fewer evaluations.
    if (done && (journal.finished[i].converged || journal.finished[i].evaluations >= settings_.evaluations ||
                 out_of_time(kDescentShare)))
      continue;
    FitStart start = descend(journal, int(i), journal.chosen[i]);
    if (stopped()) return std::nullopt;
    if (done)
      journal.finished[i] = std::move(start);
    else
      journal.finished.push_back(std::move(start));
  }
  const bool cut_short = out_of_time(kDescentShare) && !all_converged(journal);
  const FitStart& best = best_of(journal);
  const Polished polished =
      polish([this](std::span<const double> x, int samples, uint32_t number) { return round(x, samples, number); },
             best.to, settings_.final_samples, settings_.cells, [this] { return stop_() || out_of_time(kPolishShare); },
             [&](std::span<const double> x, double loss) { keep(journal, settings_.starts, x, loss); });
  if (stopped()) return std::nullopt;
  FitResult result = judge(best, polished);
  result.out_of_time = cut_short || (!polished.converged && out_of_time(kPolishShare));
  journal.seconds = now() - begun_;
  return result;
}

}  // namespace wale::fit
