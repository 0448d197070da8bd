// Sample points: the net property that scrambling keeps, independence between pixels, scrambles and dimension sets.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "tests/kernels/kernel_runner.h"
#include "tests/kernels/statistics.h"

namespace wale {
namespace {
using namespace test;

const char* kKernels = R"(
#include "sampling/sobol.clh"
#include "sampling/dimensions.clh"
/* pixel, sample, seed, set (4 uints) -> 4 numbers */
__kernel void points(__global const uint* in, __global float* out, uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  const WSampler s = w_sampler(in[4 * i], in[4 * i + 1], in[4 * i + 2]);
  vstore4(w_sample4(&s, in[4 * i + 3]), i, out);
}
__kernel void keys(__global const uint* in, __global float* out, uint count) {
  const uint i = get_global_id(0);
  if (i < count) out[i] = w_hash_uniform(w_ray_key(in[4 * i], in[4 * i + 1], in[4 * i + 2], in[4 * i + 3], 1u));
}
)";

// Points s, s + step, ... of one pixel and set.
std::vector<double> points(const KernelRunner& runner, uint32_t pixel, uint32_t first, uint32_t step, uint32_t count,
                           uint32_t set, uint32_t seed = 1) {
  std::vector<uint32_t> in;
  for (uint32_t i = 0; i < count; ++i) in.insert(in.end(), {pixel, first + i * step, seed, set});
  return runner.run("points", count, 4, runner.upload(in));
}

TEST(Sobol, EveryScrambleIsANetInItsFirstTwoDimensions) {
  const KernelRunner runner(kKernels, false);
  for (const uint32_t scramble : {0u, 3u, 7u})
    for (const uint32_t set : {0u, 1u, 6u}) {
      const auto p = points(runner, 1234, scramble, 8, 256, set);
      for (int bits = 0; bits <= 8; ++bits) {  // 2^bits columns by 2^(8-bits) rows, one point in each
        std::set<int> cells;
        for (int i = 0; i < 256; ++i)
          cells.insert(int(p[4 * i] * (1 << bits)) * 256 + int(p[4 * i + 1] * (1 << (8 - bits))));
        EXPECT_EQ(cells.size(), 256u) << "scramble " << scramble << " set " << set << " columns 2^" << bits;
      }
    }
}

// Lane l of work-item i: sampler W_LANES i + l, whose index and scramble are any numbers.
const char* kLanes = R"(
#undef W_LANES
#define W_LANES LANES
#include "sampling/sobol_lanes.clh"
__kernel void points(__global const uint* in, uint set, __global float* out, uint count) {
  const uint first = get_global_id(0) * W_LANES;
  if (first >= count) return;
  WSamplers samplers;
  for (uint i = 0; i < W_LANES; ++i) {
    const WSampler one = {in[2 * (first + i)], in[2 * (first + i) + 1]};
    w_samplers_set_lane(&samplers, i, one);
  }
  const WNumbers u = w_samplers4(&samplers, set);
  for (uint i = 0; i < W_LANES; ++i)
    vstore4((float4)(w_lane_of(u.x, i), w_lane_of(u.y, i), w_lane_of(u.z, i), w_lane_of(u.w, i)), first + i, out);
}
)";

TEST(Sobol, SideBySideIsAsOneByOne) {
  std::mt19937 random(3);
  std::vector<uint32_t> in;
  for (int i = 0; i < 1600; ++i) in.insert(in.end(), {i < 800 ? uint32_t(i) : uint32_t(random()), uint32_t(random())});
  std::vector<double> expected[2];
  for (const std::string lanes : {"1", "8", "16"}) {
    const KernelRunner runner(kLanes, false, "-DLANES=" + lanes);
    for (const uint32_t set : {0u, 7u}) {
      const auto got = runner.run("points", 1600, 4, runner.upload(in), set);
      if (lanes == "1") expected[set ? 1 : 0] = got;
      EXPECT_EQ(got, expected[set ? 1 : 0]) << lanes << " lanes, set " << set;
    }
  }
}

TEST(Sobol, EveryDimensionIsStratified) {
  const KernelRunner runner(kKernels, false);
  for (const uint32_t count : {16u, 256u, 1024u}) {
    const auto p = points(runner, 99, 5, 8, count, 2);
    for (int k = 0; k < 4; ++k) {
      std::set<int> strata;
      for (uint32_t i = 0; i < count; ++i) {
        EXPECT_GE(p[4 * i + k], 0);
        EXPECT_LT(p[4 * i + k], 1);
        strata.insert(int(p[4 * i + k] * count));
      }
      EXPECT_EQ(strata.size(), count) << "dimension " << k;
    }
  }
}

TEST(Sobol, ConvergesFasterThanRandom) {
  const KernelRunner runner(kKernels, false);
  double square = 0;
  constexpr int kPixels = 64;
  for (int pixel = 0; pixel < kPixels; ++pixel) {
    const auto p = points(runner, pixel, 0, 8, 256, 1);
    double sum = 0;
    for (int i = 0; i < 256; ++i) sum += p[4 * i] * p[4 * i + 1] * p[4 * i + 2] * p[4 * i + 3];
    square += std::pow(sum / 256 - 1.0 / 16, 2) / kPixels;
  }
  const double random_variance = (std::pow(1.0 / 3, 4) - std::pow(1.0 / 16, 2)) / 256;
  EXPECT_LT(square, random_variance / 10);
}

double correlation(const std::vector<double>& a, const std::vector<double>& b, int i, int j) {
  double sum = 0;
  for (size_t k = 0; k < a.size() / 4; ++k) sum += (a[4 * k + i] - 0.5) * (b[4 * k + j] - 0.5);
  return sum * 12 / (a.size() / 4.0);
}

// Pearson correlation of the same sample of different pixels, scrambles, sets and seeds, over many pairs: 5 sigma.
TEST(Sobol, PixelsScramblesSetsAndSeedsAreIndependent) {
  const KernelRunner runner(kKernels, false);
  constexpr uint32_t kCount = 1 << 15;
  const auto one_per_pixel = [&](uint32_t step, uint32_t sample, uint32_t set, uint32_t seed) {
    std::vector<uint32_t> in;
    for (uint32_t i = 0; i < kCount; ++i) in.insert(in.end(), {i + step, sample, seed, set});
    return runner.run("points", kCount, 4, runner.upload(in));
  };
  const auto base = one_per_pixel(0, 0, 1, 1);
  const double bound = 5 / std::sqrt(double(kCount));
  for (const auto& other : {one_per_pixel(1, 0, 1, 1), one_per_pixel(1024, 0, 1, 1), one_per_pixel(0, 1, 1, 1),
                            one_per_pixel(0, 0, 2, 1), one_per_pixel(0, 0, 1, 2)})
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) EXPECT_LT(std::abs(correlation(base, other, i, j)), bound);
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < i; ++j) EXPECT_LT(std::abs(correlation(base, base, i, j)), bound);
  std::vector<double> counts(64, 0);
  for (uint32_t i = 0; i < kCount; ++i) counts[int(base[4 * i] * 8) * 8 + int(base[4 * i + 1] * 8)] += 1;
  EXPECT_GT(chi_squared_p(counts, std::vector<double>(64, kCount / 64.0)), 1e-4);
}

TEST(RayKey, IsUniformAndDiffersInEveryPart) {
  const KernelRunner runner(kKernels, false);
  constexpr uint32_t kCount = 1 << 16;
  for (int part = 0; part < 4; ++part) {
    std::vector<uint32_t> in;
    for (uint32_t i = 0; i < kCount; ++i)
      for (int k = 0; k < 4; ++k) in.push_back(k == part ? i : 0);
    const auto out = runner.run("keys", kCount, 1, runner.upload(in));
    std::vector<double> counts(256, 0);
    for (const double v : out) counts[int(v * 256)] += 1;
    EXPECT_GT(chi_squared_p(counts, std::vector<double>(256, kCount / 256.0)), 1e-4) << part;
  }
}

}  // namespace
}  // namespace wale
