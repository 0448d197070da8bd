// Materials that nobody knows, found again from pictures of them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <random>

#include "host/fit/fit.h"
#include "host/fit/loss.h"
#include "tests/image/picture.h"
#include "tests/image/program.h"

namespace wale::test {
namespace {
using namespace fit;

bool long_tests() {
  const char* given = std::getenv("WALE_LONG_TESTS");
  return given && std::string(given) == "1";
}

struct Hidden {
  const char* name;
  const char* preset;
  Rgb transmit, reflect;
  double roughness, optical_radius, fibre_twist;  ///< degrees, -, degrees
};

const Hidden kHidden[] = {
    {"cream wool", "wool", {0.90, 0.84, 0.70}, {0.85, 0.78, 0.62}, 7, 2.3, 18},
    {"dark blue cotton", "cotton", {0.18, 0.28, 0.60}, {0.12, 0.20, 0.48}, 12, 3.2, 22},
    {"red silk", "silk", {0.85, 0.25, 0.15}, {0.70, 0.16, 0.12}, 3.5, 4.0, 6},
    {"green mohair", "mohair", {0.45, 0.75, 0.40}, {0.40, 0.66, 0.42}, 5, 1.5, 12},
};

FitTarget target_of(const Scene& scene) {
  FitTarget target;
  target.material = size_t(scene.fabrics[0].material);
  target.fabrics = {0};
  return target;
}

// Photographs of a hidden material: another seed, more samples, and a camera's noise.
PicturePair photographs(LitPair& camera, const Scene& scene, int samples, uint32_t seed) {
  PicturePair pair = camera.render(scene, samples, seed);
  std::mt19937 random(seed);
  std::normal_distribution<float> noise(0, 0.01f);
  for (fit::Picture* side : {&pair.front, &pair.back}) {
    if (side->count() == 0) continue;
    const auto mean = float(brightness(*side));
    for (float& v : side->pixels) v = std::max(0.0f, v + noise(random) * std::sqrt(std::max(v * mean, 0.0f)));
  }
  return pair;
}

struct Answer {
  FitResult result;
  FitJournal journal;
  double floor = 0;  ///< loss of the hidden material itself: what the photographs have of noise
  std::vector<double> hidden;
};

struct Trial {
  int side = 102, photograph_samples = 512, samples = 16, final_samples = 256;
  std::array<bool, 2> sides = {true, true};
};

Answer answer(const Hidden& hidden, const Trial& trial) {
  Scene scene = read_scene(std::string(WALE_SOURCE_DIR) + "/scenes/photo.json");
  scene.film.width = scene.film.height = trial.side;
  const FitTarget target = target_of(scene);
  FitSettings settings;
  settings.parameters = fit_parameters("");
  settings.target = target;
  settings.samples = trial.samples;
  settings.final_samples = trial.final_samples;
  settings.starts = 1;
  settings.evaluations = 250;
  scene.materials[target.material].yarn.preset = hidden.preset;

  Scene truth = scene;
  PlyAppearance& yarn = truth.materials[target.material].yarn;
  constexpr double kDegree = 3.14159265358979 / 180;
  yarn.forward = hidden.transmit, yarn.back = hidden.reflect;
  yarn.roughness = hidden.roughness * kDegree;
  yarn.optical_radius = hidden.optical_radius;
  yarn.fibre_twist = hidden.fibre_twist * kDegree;

  const Loaders loaders{[](const auto& file) { return read_mesh(file); }, {}};
  LitPair renderer(device(), loaders, {}, trial.sides);
  // A loss wants two pictures; one that is not there does not count.
  const auto whole = [&](PicturePair pair) {
    if (!trial.sides[0]) pair.front = pair.back;
    if (!trial.sides[1]) pair.back = pair.front;
    return pair;
  };
  LossOptions options;
  options.front = trial.sides[0], options.back = trial.sides[1];
  const Loss loss(whole(photographs(renderer, truth, trial.photograph_samples, 900)), options);
  // A far start: grey, dull and sparse, whatever the cloth.
  PlyAppearance& start = scene.materials[target.material].yarn;
  start.forward = start.back = Rgb{0.5, 0.5, 0.5};
  start.roughness = 20 * kDegree;
  start.optical_radius = 0.8;
  start.fibre_twist = 0;
  settings.cells = loss.cells();
  Fit fit(
      scene, renderer, [&](const PicturePair& pair) { return loss.residuals(whole(pair)); }, settings);
  Answer out;
  const bool tell = std::getenv("WALE_FIT_STEPS") != nullptr;
  out.result = *fit.run(
      out.journal, [] { return false; },
      [&](const FitProgress& p) {
        const FitStep& step = p.journal->steps.back();
        if (tell)
          fmt::print(stderr, "{} {:.0f} s: {:.5g}{}\n", step.start, step.seconds, step.loss, p.better ? " *" : "");
      });
  Residuals at;
  for (const uint32_t seed : {500u, 501u})
    at.replicates.push_back({loss.residuals(whole(renderer.render(truth, trial.final_samples / 4, seed)))});
  out.floor = at.loss();
  for (const FitParameter& p : settings.parameters) out.hidden.push_back(p.group->get(truth, target, p.k));
  return out;
}

// `gloss`: the highlight's width and the optical thickness too.
void expect_found(const Answer& a, const std::string& name, bool gloss) {
  const std::vector<FitParameter> parameters = fit_parameters("");
  std::string text = fmt::format("{}: loss {:.4g}, floor {:.4g}, {} pairs, {:.0f} s", name, a.result.best.loss, a.floor,
                                 a.journal.steps.size(), a.journal.seconds);
  for (size_t k = 0; k < parameters.size(); ++k) {
    const FittedParameter& p = a.result.parameters[k];
    text += fmt::format("; {} {:.4g} ({:.4g}, {:.2g})", parameters[k].name(), p.value, a.hidden[k],
                        p.high ? (*p.high - *p.low) / 4 : -1.0);
    const std::string group = parameters[k].group->name;
    if (group == "transmit" || group == "reflect") {
      EXPECT_NEAR(p.value, a.hidden[k], 0.02) << name << ": " << parameters[k].name();
    } else if (gloss && (group == "roughness" || group == "optical_radius")) {
      EXPECT_NEAR(p.value / a.hidden[k], 1, 0.1) << name << ": " << parameters[k].name();
    }
    ASSERT_TRUE(p.low && p.high) << name << ": " << parameters[k].name();
    const double deviation = (*p.high - *p.low) / 4;
    EXPECT_LT(std::abs(p.value - a.hidden[k]), 4 * deviation)
        << name << ": " << parameters[k].name() << " and its range";
    EXPECT_TRUE(p.determined) << name << ": " << parameters[k].name();
  }
  EXPECT_TRUE(a.result.best.converged);
  EXPECT_LT(a.result.best.loss, 1.05 * a.floor) << name;
  fmt::print("{}\n", text);
}

const Answer& cotton() {
  static const Answer found = answer(kHidden[1], {.side = 48, .final_samples = 1024});
  return found;
}

// So few pixels and samples tell the colours; gloss asks for more of both.
TEST(FitKnownAnswer, ColoursOfOneMaterial) { expect_found(cotton(), kHidden[1].name, false); }

// What leaves a ply forward and what turns back make much the same picture from in front.
TEST(FitKnownAnswer, OnlyThePairTellsTransmissionFromReflection) {
  const Answer& pair = cotton();
  const Answer front = answer(kHidden[1], {.side = 48, .final_samples = 512, .sides = {true, false}});
  const std::vector<FitParameter> parameters = fit_parameters("");
  for (size_t k = 0; k < parameters.size(); ++k) {
    if (std::string(parameters[k].group->name) != "transmit") continue;
    const FittedParameter &by_pair = pair.result.parameters[k], &by_front = front.result.parameters[k];
    ASSERT_TRUE(by_pair.low);
    const double sure = *by_pair.high - *by_pair.low;
    const double unsure = by_front.low ? *by_front.high - *by_front.low : parameters[k].high - parameters[k].low;
    fmt::print("{} ({:.3g}): pair {:.3g}, range {:.2g}; front alone {:.3g}, range {:.2g}\n", parameters[k].name(),
               pair.hidden[k], by_pair.value, sure, by_front.value, unsure);
    EXPECT_GT(unsure, 5 * sure) << parameters[k].name();
  }
}

// A photograph has ten times the pixels across, and a camera's noise in each; averages of a hundred have little left of
// it. A render that stands for one needs many samples.
class FitHidden : public testing::TestWithParam<Hidden> {};

TEST_P(FitHidden, IsFoundWithItsGloss) {
  if (!long_tests()) GTEST_SKIP() << "ten minutes: WALE_LONG_TESTS=1";
  expect_found(answer(GetParam(), {.photograph_samples = 2048, .samples = 32, .final_samples = 2048}), GetParam().name,
               true);
}

INSTANTIATE_TEST_SUITE_P(FourMaterials, FitHidden, testing::ValuesIn(kHidden), [](const auto& tested) {
  std::string name = tested.param.name;
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
});

}  // namespace
}  // namespace wale::test
