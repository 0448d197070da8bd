// Invariants of scattering at the limits of its parameters: random plies, fibres and coated surfaces, random
// directions, those along the axis and in the surface among them.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/materials.h"
#include "tests/kernels/ply_kernels.h"
#include "tests/kernels/scattering_property_kernels.h"
#include "tests/kernels/statistics.h"
#include "tests/kernels/synthetic.h"
#include "tests/property.h"
#include "tests/tolerances.h"

namespace wale::test {
namespace {

using std::numbers::pi;

/// A number from `low` to `high`, one time in four one of the two ends.
double with_ends(const char* name, double low, double high) {
  const int end = *rc::gen::inRange(0, 8).as(std::string(name) + " end");
  const double x = *number_between(low, high).as(name);
  return end == 6 ? low : end == 7 ? high : x;
}

Rgb random_color() { return {with_ends("red", 0, 1), with_ends("green", 0, 1), with_ends("blue", 0, 1)}; }

PlyAppearance random_ply() {
  PlyAppearance a;
  a.preset = ply_presets()[*rc::gen::inRange(size_t(0), ply_presets().size()).as("preset")];
  a.roughness = std::pow(10, with_ends("log roughness", -3, 0));
  a.ior = with_ends("ior", 1, 3);
  a.fibre_color = random_color();
  a.fibre_twist = with_ends("twist", -80 * pi / 180, 80 * pi / 180);
  return a;
}

/// Viewer anywhere: across the ply, grazing it, along its axis.
std::array<dvec3, 3> random_view() { return ply_view(with_ends("h", -1, 1), with_ends("theta", -pi / 2, pi / 2)); }

std::vector<float> uniforms(size_t count) {
  Random random(*rc::gen::arbitrary<uint32_t>().as("seed"));
  std::vector<float> u(count);
  for (float& x : u) x = random.uniform_float();
  return u;
}

constexpr size_t kSamples = 20000;
constexpr int kBins = 12, kSub = 12;

/// Limits of bins that hold about as many samples each, in double the sample's own spacing.
std::vector<double> quantiles(std::vector<double> x) {
  std::sort(x.begin(), x.end());
  std::vector<double> limits;
  for (int i = 0; i <= kBins; ++i) limits.push_back(x[std::min(x.size() - 1, x.size() * size_t(i) / kBins)]);
  return limits;
}

/// p-value of "samples follow the density". A point (x, y) of the plane stands for a direction; `density` is per dx dy.
/// Bins follow the first half of the samples, the second half is counted: a lobe 0.001 wide has as many as a broad one.
template <typename Density>
double sampling_p(const std::vector<std::array<double, 2>>& samples, const Density& density) {
  const size_t half = samples.size() / 2;
  std::vector<double> x, y;
  for (size_t i = 0; i < half; ++i) {
    x.push_back(samples[i][0]);
    y.push_back(samples[i][1]);
  }
  const std::vector<double> xs = quantiles(x), ys = quantiles(y);
  for (int i = 0; i < kBins; ++i)  // all at one place: nothing to count
    if (!(xs[i + 1] > xs[i]) || !(ys[i + 1] > ys[i])) return 1;
  std::vector<std::array<double, 2>> points;
  std::vector<double> area;
  for (int i = 0; i < kBins * kSub; ++i)
    for (int j = 0; j < kBins * kSub; ++j) {
      const double dx = (xs[i / kSub + 1] - xs[i / kSub]) / kSub, dy = (ys[j / kSub + 1] - ys[j / kSub]) / kSub;
      points.push_back({xs[i / kSub] + (i % kSub + 0.5) * dx, ys[j / kSub] + (j % kSub + 0.5) * dy});
      area.push_back(dx * dy);
    }
  const std::vector<double> values = density(points);
  // The last cell is all that lies outside.
  std::vector<double> expected(kBins * kBins + 1, 0), counts(kBins * kBins + 1, 0);
  const double n = double(samples.size() - half);
  expected.back() = n;
  for (size_t i = 0; i < points.size(); ++i) {
    const size_t bin = (i / (kBins * kSub) / kSub) * kBins + i % (kBins * kSub) / kSub;
    expected[bin] += n * values[i] * area[i];
    expected.back() -= n * values[i] * area[i];
  }
  expected.back() = std::max(expected.back(), 0.0);
  for (size_t i = half; i < samples.size(); ++i) {
    const auto bin = [](const std::vector<double>& limits, double v) {
      return int(std::upper_bound(limits.begin(), limits.end(), v) - limits.begin()) - 1;
    };
    const int a = bin(xs, samples[i][0]), b = bin(ys, samples[i][1]);
    const bool inside = a >= 0 && b >= 0 && a < kBins && b < kBins;
    counts[inside ? size_t(a * kBins + b) : counts.size() - 1] += 1;
  }
  return chi_squared_p(counts, expected);
}

constexpr int kCases = 24;

/// Where a device can: along the axis a float sine near 1 leaves lobes of 0.001 rad some dozen cones only. What floats
/// do at ordinary widths is tested beside the other samples.
bool in_double() { return test_device().traits().fp64; }

TEST(PlyScattering, SamplesFollowTheDensityAtEveryLimit) {
  const KernelRunner runner(kScatteringKernels, in_double());
  check_property(kCases, [&] {
    const auto material = runner.upload<WPlyMaterial>({ply_material(random_ply())});
    const auto view = runner.upload(floats(random_view()));
    const auto u = runner.upload(uniforms(4 * kSamples));
    const cl_int lobe = *rc::gen::inRange(0, 3).as("lobe");
    const auto out = runner.run("ply_samples", kSamples, 2, material, view, u, lobe);
    std::vector<std::array<double, 2>> samples;
    for (size_t i = 0; i < kSamples; ++i) samples.push_back({out[2 * i], out[2 * i + 1]});
    const double p = sampling_p(samples, [&](const std::vector<std::array<double, 2>>& points) {
      std::vector<float> in;
      for (const auto& q : points) in.insert(in.end(), {float(q[0]), float(q[1])});
      return runner.run("ply_density", points.size(), 1, material, view, runner.upload(in), lobe);
    });
    RC_ASSERT(p > tolerance::kFamilyP / kCases);
  });
}

TEST(FibreScattering, SamplesFollowTheDensityAtEveryLimit) {
  const KernelRunner runner(kScatteringKernels, in_double());
  check_property(kCases, [&] {
    WFibreMaterial m = fibre_material(random_ply());
    m.beta_r = float(std::pow(10, with_ends("log beta_r", -3, 0)));
    m.beta_tt = float(std::pow(10, with_ends("log beta_tt", -3, 0)));
    m.gamma_tt = float(std::pow(10, with_ends("log gamma", -2, 0.3)));
    const auto material = runner.upload<WFibreMaterial>({m});
    const auto view = runner.upload(floats(random_view()));
    const auto u = runner.upload(uniforms(4 * kSamples));
    const cl_int lobe = *rc::gen::inRange(0, 2).as("lobe");
    const auto out = runner.run("fibre_samples", kSamples, 2, material, view, u, lobe);
    std::vector<std::array<double, 2>> samples;
    for (size_t i = 0; i < kSamples; ++i) samples.push_back({out[2 * i], out[2 * i + 1]});
    const double p = sampling_p(samples, [&](const std::vector<std::array<double, 2>>& points) {
      std::vector<float> in;
      for (const auto& q : points) in.insert(in.end(), {float(q[0]), float(q[1])});
      return runner.run("fibre_density", points.size(), 1, material, view, runner.upload(in), lobe);
    });
    RC_ASSERT(p > tolerance::kFamilyP / kCases);
  });
}

// Weights of samples are the energies of lobes: never negative, never above 1, 1 for white.
TEST(PlyScattering, NeverGivesBackMoreThanItGets) {
  const KernelRunner runner(kPlyKernels, false);
  check_property(60, [&] {
    PlyAppearance a = random_ply();
    const bool white = *rc::gen::inRange(0, 3).as("white") == 0;
    if (white) a.fibre_color = Rgb{1, 1, 1};
    const auto m = runner.upload<WPlyMaterial>({ply_material(a)});
    std::vector<float> views;
    for (int i = 0; i < 64; ++i) {
      const std::vector<float> view =
          floats(i < 4 ? random_view() : ply_view(2 * i / 63.0 - 1, pi * (i * 7 % 64) / 63 - pi / 2));
      views.insert(views.end(), view.begin(), view.end());
    }
    const auto out = runner.run("energies", 64, 15, m, runner.upload(views));
    for (size_t i = 0; i < 64; ++i)
      for (int k = 0; k < 3; ++k) {
        const double* o = &out[15 * i + k];
        RC_ASSERT(o[0] >= 0);
        RC_ASSERT(o[3] >= 0);
        RC_ASSERT(o[6] >= 0);
        RC_ASSERT(o[0] + o[3] + o[6] <= 1 + tolerance::kFurnace);
        if (white) RC_ASSERT(o[0] + o[3] + o[6] >= 1 - tolerance::kFurnace);
      }
  });
}

TEST(SurfaceScattering, GivesBackNoMoreThanItGetsAndTheSameBothWays) {
  const KernelRunner runner(kScatteringKernels, false);
  const KernelRunner twice(kScatteringKernels, in_double());
  check_property(40, [&] {
    SurfaceAppearance a;
    a.coated = true;
    a.roughness = with_ends("roughness", 0, 1);
    a.ior = with_ends("ior", 1, 4);
    a.color = random_color();
    const WSurfaceMaterial m = surface_material(a);
    const double mu = std::max(1e-4, with_ends("cosine", 0, 1));
    const std::vector<float> view = {float(std::sqrt(1 - mu * mu)), 0, float(mu)};
    const auto out = runner.run("surface_weights", kSamples, 4, runner.upload<WSurfaceMaterial>({m}),
                                runner.upload(view), runner.upload(uniforms(3 * kSamples)));
    for (int k = 0; k < 3; ++k) {
      double mean = 0, square = 0;
      for (size_t i = 0; i < kSamples; ++i) {
        RC_ASSERT(std::isfinite(out[4 * i + k]) && out[4 * i + k] >= 0);
        mean += out[4 * i + k] / kSamples;
        square += out[4 * i + k] * out[4 * i + k] / kSamples;
      }
      const double error = std::sqrt(std::max(0.0, square - mean * mean) / kSamples);
      RC_ASSERT(mean <= 1 + tolerance::kSurfaceFurnace + 4 * error);
    }
    // Helmholtz: f(v, l) = f(l, v), in double, where the coat's peak does not round.
    std::vector<float> pairs;
    Random random(*rc::gen::arbitrary<uint32_t>().as("pairs"));
    constexpr size_t kPairs = 500;
    for (size_t i = 0; i < 2 * kPairs; ++i) {
      const dvec3 w = random.direction();
      for (const double x : {w.x, w.y, i % 7 ? std::abs(w.z) + 0.01 : 0.01}) pairs.push_back(float(x));
    }
    const auto f = twice.run("surface_both_ways", kPairs, 6, twice.upload<WSurfaceMaterial>({m}), twice.upload(pairs));
    for (size_t i = 0; i < kPairs; ++i)
      for (int k = 0; k < 3; ++k)
        RC_ASSERT(std::abs(f[6 * i + k] - f[6 * i + 3 + k]) <= tolerance::kReciprocity * (f[6 * i + k] + 1e-6));
  });
}

}  // namespace
}  // namespace wale::test
