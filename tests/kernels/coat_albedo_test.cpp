// The coat's albedo tables against an integration of their own, at the nodes and between them.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/kernels/kernel_runner.h"
#include "tests/kernels/statistics.h"
#include "tests/tolerances.h"

namespace wale {
namespace {
using namespace test;

// E = integral over half vectors of D G2/(4 mu_v mu_l) F mu_l dl, by visible normals: mean of F G2/G1 over the cap of
// the stretched view The squared coordinate
// is fine at the grazing end of the cap, whose reflections go below the surface.
double coat_albedo(double mu, double alpha, double f0, int n) {
  const double sine = std::sqrt(1 - mu * mu);
  const dvec3 v(sine, 0, mu), stretched = glm::normalize(dvec3(alpha * sine, 0, mu));
  const auto tan2 = [](double z) { return (1 - z * z) / (z * z); };
  const auto lambda = [&](double z) { return (std::sqrt(1 + alpha * alpha * tan2(z)) - 1) / 2; };
  double sum = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double part = (i + 0.5) / n;
      const double z = (1 + stretched.z) * part * part - stretched.z, phi = 2 * M_PI * (j + 0.5) / n;
      const double r = std::sqrt(std::max(0.0, 1 - z * z));
      dvec3 h = dvec3(r * std::cos(phi), r * std::sin(phi), z) + stretched;
      h = glm::normalize(dvec3(alpha * h.x, alpha * h.y, std::max(h.z, 0.0)));
      const double vh = glm::dot(v, h), mu_l = 2 * vh * h.z - mu;
      if (mu_l <= 0) continue;
      const double fresnel = f0 + (1 - f0) * std::pow(1 - vh, 5);
      sum += 2 * part * fresnel * (1 + lambda(mu)) / (1 + lambda(mu) + lambda(mu_l));
    }
  return sum / (double(n) * n);
}

const char* kKernel = R"(
#include "appearance/coat_albedo.clh"
/* mu, alpha, f0 -> E(mu), mean */
__kernel void albedo(__global const float* in, __global w_real* out, uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  out[2 * i] = w_coat_albedo(in[3 * i], in[3 * i + 1], in[3 * i + 2]);
  out[2 * i + 1] = w_coat_mean_albedo(in[3 * i + 1], in[3 * i + 2]);
}
)";

constexpr double kMinRoughness = 0.0316227766;

TEST(CoatAlbedo, NodesHoldTheIntegral) {
  const KernelRunner runner(kKernel, false);
  std::vector<float> in;
  for (int row = 0; row < 16; ++row)
    for (int column = 1; column < 16; ++column)
      for (const double f0 : {0.0, 0.04, 1.0}) {
        const double roughness = kMinRoughness + (1 - kMinRoughness) * row / 15, alpha = roughness * roughness;
        const double x = column / 15.0, mu = x * alpha / (1 + alpha - x);
        for (const double value : {mu, alpha, f0}) in.push_back(float(value));
      }
  const auto out = runner.run("albedo", in.size() / 3, 2, runner.upload(in));
  for (size_t i = 0; i < in.size() / 3; ++i)
    EXPECT_NEAR(out[2 * i], coat_albedo(std::min(1.0f, in[3 * i]), in[3 * i + 1], in[3 * i + 2], 64),
                tolerance::kCoatTable)
        << "mu " << in[3 * i] << " alpha " << in[3 * i + 1] << " f0 " << in[3 * i + 2];
}

TEST(CoatAlbedo, InterpolationStaysClose) {
  const KernelRunner runner(kKernel, false);
  Random random(2);
  std::vector<float> in;
  for (int i = 0; i < 1000; ++i) {
    const double roughness = random.uniform(kMinRoughness, 1), mu = std::pow(random.uniform(0.03, 1), 2);
    for (const double value : {mu, roughness * roughness, random.uniform(0, 0.25)}) in.push_back(float(value));
  }
  const auto out = runner.run("albedo", in.size() / 3, 2, runner.upload(in));
  double worst = 0;
  for (size_t i = 0; i < in.size() / 3; ++i)
    worst = std::max(worst, std::abs(out[2 * i] - coat_albedo(in[3 * i], in[3 * i + 1], in[3 * i + 2], 48)));
  EXPECT_LT(worst, tolerance::kSurfaceFurnace);
  RecordProperty("worst", std::to_string(worst));
}

TEST(CoatAlbedo, MeanIsTheCosineWeightedIntegral) {
  const KernelRunner runner(kKernel, false);
  for (const double roughness : {kMinRoughness, 0.17, 0.5, 0.83, 1.0}) {
    std::vector<float> in;
    constexpr int kSteps = 1000;
    for (int i = 0; i < kSteps; ++i)
      for (const double value : {std::sqrt((i + 0.5) / kSteps), roughness * roughness, 0.04})
        in.push_back(float(value));
    const auto out = runner.run("albedo", kSteps, 2, runner.upload(in));
    double mean = 0;
    for (int i = 0; i < kSteps; ++i) mean += out[2 * i] / kSteps;
    EXPECT_NEAR(out[1], mean, tolerance::kCoatTable) << roughness;
  }
}

}  // namespace
}  // namespace wale
