// The elementary functions of shading against those of the C++ library, over the arguments that shading has.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "tests/kernels/kernel_runner.h"
#include "tests/tolerances.h"

namespace wale {
namespace {
using namespace test;

const char* kKernels = R"(
#include "shared/elementary.clh"
__kernel void exponentials(__global const float* x, __global w_real* out, uint count) {
  const uint i = get_global_id(0);
  if (i < count) out[i] = w_exp(x[i]);
}
__kernel void logarithms(__global const float* x, __global w_real* out, uint count) {
  const uint i = get_global_id(0);
  if (i < count) out[i] = w_log(x[i]);
}
__kernel void complements(__global const float* x, __global w_real* out, uint count) {
  const uint i = get_global_id(0);
  if (i < count) out[i] = w_one_minus_exp(x[i], w_exp(-x[i]));
}
__kernel void circles(__global const float* x, __global w_real* out, uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  w_real c;
  out[4 * i] = w_sincos(x[i], &c);
  out[4 * i + 1] = c;
  out[4 * i + 2] = w_sincos_turns(x[i], &c);
  out[4 * i + 3] = c;
}
__kernel void angles(__global const float* yx, __global w_real* out, uint count) {
  const uint i = get_global_id(0);
  if (i < count) out[i] = w_atan2(yx[2 * i], yx[2 * i + 1]);
}
)";

constexpr size_t kCount = 100000;
constexpr double kPi = std::numbers::pi;

std::vector<float> spread(double low, double high, bool by_factors = false) {
  std::vector<float> x(kCount);
  for (size_t i = 0; i < kCount; ++i) {
    const double f = double(i) / (kCount - 1);
    x[i] = float(by_factors ? low * std::pow(high / low, f) : low + (high - low) * f);
  }
  return x;
}

double worst_relative(const char* kernel, const std::vector<float>& x, const std::function<double(double)>& exact,
                      double least) {
  const KernelRunner runner(kKernels, false);
  const auto got = runner.run(kernel, x.size(), 1, runner.upload(x));
  double worst = 0;
  for (size_t i = 0; i < x.size(); ++i) {
    const double e = exact(double(x[i]));
    worst = std::max(worst, std::abs(got[i] - e) / std::max(std::abs(e), least));
  }
  return worst;
}

TEST(Elementary, Exponential) {
  EXPECT_LT(worst_relative(
                "exponentials", spread(-86, 80), [](double x) { return std::exp(x); }, 0),
            tolerance::kElementary);
  EXPECT_LT(worst_relative(
                "exponentials", spread(-1e4, -87), [](double) { return 0.0; }, 1),
            1e-37);
}

TEST(Elementary, Logarithm) {
  // Near 1, where the value vanishes, absolutely.
  EXPECT_LT(worst_relative(
                "logarithms", spread(1e-37, 1e37, true), [](double x) { return std::log(x); }, 0.1),
            tolerance::kElementary);
}

TEST(Elementary, OneMinusExponential) {
  EXPECT_LT(worst_relative(
                "complements", spread(1e-6, 80, true), [](double x) { return -std::expm1(-x); }, 0),
            tolerance::kElementary);
}

TEST(Elementary, Circle) {
  const KernelRunner runner(kKernels, false);
  const std::vector<float> x = spread(-40, 40);
  const auto got = runner.run("circles", x.size(), 4, runner.upload(x));
  double radians = 0, turns = 0;
  for (size_t i = 0; i < x.size(); ++i) {
    const double a = double(x[i]), b = 2 * kPi * (a - std::floor(a));
    radians = std::max({radians, std::abs(got[4 * i] - std::sin(a)), std::abs(got[4 * i + 1] - std::cos(a))});
    turns = std::max({turns, std::abs(got[4 * i + 2] - std::sin(b)), std::abs(got[4 * i + 3] - std::cos(b))});
  }
  EXPECT_LT(radians, tolerance::kElementary);
  EXPECT_LT(turns, tolerance::kElementary);
}

TEST(Elementary, Angle) {
  const KernelRunner runner(kKernels, false);
  std::vector<float> yx;
  for (size_t i = 0; i < kCount; ++i) {
    const double angle = kPi * (2.0 * double(i) / (kCount - 1) - 1), r = std::pow(10, double(i % 13) - 6);
    yx.push_back(float(r * std::sin(angle)));
    yx.push_back(float(r * std::cos(angle)));
  }
  for (const float x : {-1.0f, 0.0f, 1.0f})
    for (const float y : {-1.0f, 0.0f, 1.0f}) yx.insert(yx.end(), {y, x});
  const auto got = runner.run("angles", yx.size() / 2, 1, runner.upload(yx));
  double worst = 0;
  for (size_t i = 0; i < got.size(); ++i) {
    const double exact = std::atan2(double(yx[2 * i]), double(yx[2 * i + 1]));
    worst = std::max(worst, std::abs(got[i] - exact) / std::max(std::abs(exact), 1e-30));
  }
  EXPECT_LT(worst, tolerance::kElementary);
}

TEST(Elementary, NaNStays) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const KernelRunner runner(kKernels, false);
  const auto x = runner.upload(std::vector<float>{nan});
  for (const char* kernel : {"exponentials", "logarithms", "complements"})
    EXPECT_TRUE(std::isnan(runner.run(kernel, 1, 1, x)[0])) << kernel;
  for (const double v : runner.run("circles", 1, 4, x)) EXPECT_TRUE(std::isnan(v));
  for (const double v : runner.run("angles", 2, 1, runner.upload(std::vector<float>{nan, 1, 0, nan})))
    EXPECT_TRUE(std::isnan(v));
}

}  // namespace
}  // namespace wale
