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

constexpr int kLooks = 4;               // places looked at for each start
constexpr double kMargin = 0.02;        // starts keep off the bounds, where derivatives are one-sided
constexpr double kUndetermined = 0.25;  // standard deviation, of the bounds' range
constexpr double kAlike = 0.95;
constexpr double kLeastStep = 2e-3;
constexpr double kDescentShare = 0.8;

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

Residuals Fit::evaluate(std::span<const double> places, int samples, bool derivatives) {
  Scene scene = scene_;
  apply_parameters(scene, settings_.target, settings_.parameters, places);
  Residuals out;
  PicturePair mean;
  for (uint32_t half = 0; half < 2; ++half) {
    const uint32_t seed = 2 * settings_.seed + half;
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

int Fit::samples_of(int start) const {
  if (start < 0) return std::max(4, settings_.samples / 4);
  return start < settings_.starts ? settings_.samples : settings_.final_samples;
}

// Judging takes pairs of renders too: time for them is left.
bool Fit::out_of_time() const { return settings_.seconds > 0 && now() - begun_ > kDescentShare * settings_.seconds; }

void Fit::keep(FitJournal& journal, int start, std::span<const double> places, double loss) {
  // Losses of different samples are not compared.
  if (start != best_start_ && samples_of(start) != samples_of(best_start_)) best_loss_ = INFINITY;
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
  for (int i = 1; i < settings_.starts * kLooks && !stop_() && !out_of_time(); ++i) {
    std::vector<double> x = spread_place(own.size(), i);
    const double loss = evaluate(x, samples_of(-1), false).loss();
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
  const int samples = samples_of(number);
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
  const std::function<bool()> ended = [this] { return stop_() || out_of_time(); };
  if (settings_.method == FitMethod::bobyqa) {
    const BobyqaResult r = bobyqa(
        [&](std::span<const double> x) {
          const double loss = evaluate(x, samples, false).loss();
          note(x, loss);
          return loss;
        },
        begin, left, kLeastStep, ended);
    out.to = r.x, out.loss = r.loss, out.converged = r.converged;
    return out;
  }
  LeastSquaresOptions options;
  options.evaluations = left;
  options.least_step = kLeastStep;
  options.stop = ended;
  const LeastSquaresResult r =
      least_squares([&](std::span<const double> x, bool derivatives) { return evaluate(x, samples, derivatives); },
                    begin, options, [&](std::span<const double> x, double loss, bool) { note(x, loss); });
  out.to = r.x, out.loss = r.residuals.loss(), out.converged = r.converged;
  return out;
}

const FitStart& Fit::best_of(const FitJournal& journal) const {
  const auto end = journal.finished.begin() + std::min<std::ptrdiff_t>(settings_.starts, std::ssize(journal.finished));
  return *std::min_element(journal.finished.begin(), end,
                           [](const FitStart& a, const FitStart& b) { return a.loss < b.loss; });
}

FitResult Fit::judge(const FitJournal& journal) {
  FitResult out;
  // Losses of different samples are not compared.
  const bool polished = journal.finished.size() > size_t(settings_.starts);
  out.best = polished ? journal.finished.back() : best_of(journal);
  const std::vector<double>& best = out.best.to;
  const size_t axes = best.size();

  const int samples = samples_of(int(journal.finished.size()) - 1);
  Residuals at = evaluate(best, samples, true);
  out.pictures = pictures_;
  // What a render of half the samples has of noise alone is half of the squared difference of two; the mean of both has
  // half of that.
  const std::vector<double>&first = at.replicates[0].values, &second = at.replicates[1].values;
  for (size_t i = 0; i < first.size(); ++i) out.render_noise += 0.25 * (first[i] - second[i]) * (first[i] - second[i]);

  // Central differences, wide enough to stand above the noise, where paths do not tell.
  constexpr double kWide = 0.05;
  for (Replicate& r : at.replicates) r.derivatives.resize(axes);
  for (size_t k = 0; k < axes; ++k) {
    if (!at.replicates[0].derivatives[k].empty()) continue;
    std::vector<double> lower = best, upper = best;
    lower[k] = std::max(0.0, best[k] - kWide);
    upper[k] = std::min(1.0, best[k] + kWide);
    const Residuals a = evaluate(lower, samples, false), b = evaluate(upper, samples, false);
    for (size_t r = 0; r < at.replicates.size(); ++r)
      for (size_t i = 0; i < first.size(); ++i)
        at.replicates[r].derivatives[k].push_back((b.replicates[r].values[i] - a.replicates[r].values[i]) /
                                                  (upper[k] - lower[k]));
  }
  const ParameterErrors errors = parameter_errors(at);
  out.alike = errors.alike(kAlike);
  for (size_t k = 0; k < axes; ++k) {
    const FitParameter& p = settings_.parameters[k];
    FittedParameter fitted;
    fitted.value = p.value(best[k]);
    fitted.start = p.value(out.best.from[k]);
    fitted.at_bound = best[k] <= 1e-3 || best[k] >= 1 - 1e-3;
    if (const auto deviation = errors.deviations[k]) {
      fitted.low = p.value(best[k] - 2 * *deviation);
      fitted.high = p.value(best[k] + 2 * *deviation);
      fitted.determined = *deviation < kUndetermined;
    }
    out.parameters.push_back(fitted);
  }
  out.scene = scene_;
  apply_parameters(out.scene, settings_.target, settings_.parameters, best);
  return out;
}

std::optional<FitResult> Fit::run(FitJournal& journal, const std::function<bool()>& stop,
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
  for (size_t i = 0; i <= size_t(settings_.starts) && (i == 0 || !out_of_time()); ++i) {
    // The last descent makes the best of the others surer.
    if (i == size_t(settings_.starts) && journal.chosen.size() == i) journal.chosen.push_back(best_of(journal).to);
    const bool done = i < journal.finished.size();
    // An earlier run may have had fewer evaluations.
    if (done && (journal.finished[i].converged || journal.finished[i].evaluations >= settings_.evaluations)) continue;
    FitStart start = descend(journal, int(i), journal.chosen[i]);
    if (stopped()) return std::nullopt;
    if (done)
      journal.finished[i] = std::move(start);
    else
      journal.finished.push_back(std::move(start));
  }
  FitResult result = judge(journal);
  result.out_of_time = out_of_time();
  journal.seconds = now() - begun_;
  return result;
}

}  // namespace wale::fit
