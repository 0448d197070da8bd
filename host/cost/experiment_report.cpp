// Experiment::report(): figures from the pictures of all repetitions.
#include <fmt/format.h>

#include <cmath>

#include "geom/error.h"
#include "host/cost/experiment.h"

namespace wale::cost {
namespace {

// Mean over the picture, weighed, of a variance per value.
double weighed(const std::vector<float>& variance, const std::vector<double>& weights) {
  double sum = 0;
  for (size_t p = 0; p < weights.size(); ++p)
    for (size_t c = 0; c < 3; ++c) sum += weights[p] * variance[3 * p + c];
  return sum;
}

std::vector<Picture> pictures_of(const std::vector<Repetition>& repetitions) {
  std::vector<Picture> out;
  for (const Repetition& r : repetitions) out.push_back(r.picture);
  return out;
}

}  // namespace

void Experiment::analyse(size_t u, const std::vector<double>& weights, const std::vector<Picture>& reference,
                         CostReport& out) {
  Measured& m = measured_[u];
  const std::vector<Repetition>& base = measured_[0].repetitions;
  UnitResult& r = m.result;
  r.repetitions = int(m.repetitions.size());
  if (m.repetitions.empty()) {
    if (r.left_out.empty()) r.left_out = "the time was over before its first repetition";
    return;
  }
  const auto seconds = [&](const Repetition& one) { return device_.traits().cpu ? one.cpu : one.wall; };
  const double paths = double(r.samples) * double(weights.size());
  const double base_paths = double(measured_[0].result.samples) * double(weights.size());
  std::vector<double> wall, cpu, time, noise;
  for (size_t i = 0; i < m.repetitions.size(); ++i) {
    const Repetition& one = m.repetitions[i];
    const double variance = r.samples * weighed(one.variance, weights);
    wall.push_back(1e9 * one.wall / paths);
    cpu.push_back(1e9 * one.cpu / paths);
    r.variance += variance / double(m.repetitions.size());
    if (i >= base.size()) continue;
    const double ratio = seconds(one) / paths / (seconds(base[i]) / base_paths);
    const double base_variance = measured_[0].result.samples * weighed(base[i].variance, weights);
    time.push_back(ratio);
    if (base_variance > 0) noise.push_back(ratio * variance / base_variance);
  }
  r.wall_ns = spread_of(wall), r.cpu_ns = spread_of(cpu), r.time = spread_of(time);
  if (!noise.empty()) r.equal_noise = spread_of(noise);
  const std::vector<Picture> pictures = pictures_of(m.repetitions);
  r.mean = mean_of(pictures);
  r.bias = given_ ? relative_bias(pictures, given_->picture, given_->variance, weights)
                  : relative_bias(pictures, reference, weights);
  r.change = relative_bias(pictures, pictures_of(base), weights);
  r.flip = flip_of(r.mean, out.reference, out.exposure);
}

CostReport Experiment::report() {
  CostReport out;
  out.device = device_.traits().name, out.driver = device_.traits().platform + ", " + device_.traits().driver;
  out.time_kind = device_.traits().cpu ? "CPU" : "wall";
  out.ended = ended_;
  out.exposure = levels_.units[0].scene.film.exposure, out.view = levels_.units[0].scene.film.view;
  out.base_settings = levels_.units[0].settings;
  const std::vector<Repetition>& made = measured_[levels_.reference].repetitions;
  std::vector<Picture> reference = pictures_of(made);
  out.reference_made = !given_;
  if (given_) {
    out.reference = given_->picture;
    out.reference_text = fmt::format("{}, {:g} samples a pixel: {}", given_->file, given_->samples, given_->accuracy);
  } else if (!reference.empty()) {
    out.reference = mean_of(reference);
    out.reference_text =
        fmt::format("{}{} repetitions of {} samples a pixel: {}", reference_note_, reference.size(),
                    measured_[levels_.reference].result.samples, levels_.units[levels_.reference].settings);
  }
  if (out.reference.rgb.empty() || measured_[0].repetitions.empty())
    user_error("cost: stopped before the scene and its reference were rendered once; nothing was written");
  const std::vector<double> weights = relative_weights(out.reference);
  if (given_) {
    out.reference_noise = std::sqrt(weighed(given_->variance, weights));
  } else {
    double variance = 0;
    for (const Repetition& r : made) variance += weighed(r.variance, weights);
    out.reference_noise = std::sqrt(variance) / double(made.size());
  }
  if (reference.size() >= 2) {
    std::vector<Picture> even, odd;
    for (size_t i = 0; i < reference.size(); ++i) (i % 2 ? odd : even).push_back(reference[i]);
    out.reference_flip = flip_of(mean_of(even), mean_of(odd), out.exposure);
  }
  for (size_t u = 0; u < measured_.size(); ++u) {
    analyse(u, weights, reference, out);
    out.results.push_back(measured_[u].result);
  }
  out.levels = std::move(levels_);
  return out;
}

}  // namespace wale::cost
