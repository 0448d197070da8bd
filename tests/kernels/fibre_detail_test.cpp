// Fibre detail on the device against geom/fibre_detail.h, and that its mean is what the filter fades to.
#include "geom/fibre_detail.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "host/fibre_tables.h"
#include "host/materials.h"
#include "tests/kernels/kernel_runner.h"
#include "tests/kernels/statistics.h"

namespace wale {
namespace {
using namespace test;

constexpr const char* kKernel = R"(
#include "appearance/fibre_detail.clh"
__kernel void fibre_at(__global const WFibreDetail* m, __global const uint* offsets, __global const float4* fibres,
                       __global const float* in, __global w_real* out, uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  const WFibreAt at = w_fibre_at(*m, offsets, fibres, cos((w_real)in[2 * i]), sin((w_real)in[2 * i]), in[2 * i + 1]);
  out[4 * i] = at.sin_turn; out[4 * i + 1] = at.tilt; out[4 * i + 2] = at.openness; out[4 * i + 3] = at.shadow;
}
__kernel void filtered(__global const WFibreDetail* m, __global const float* in, __global w_real* out, uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  WFibreAt at = w_fibre_mean(R(0.3));
  at.sin_turn = R(0.7); at.shadow = R(0.2); at.openness = R(0.1);
  at = w_fibre_filtered(*m, at, in[i]);
  out[4 * i] = at.sin_turn; out[4 * i + 1] = at.tilt; out[4 * i + 2] = at.shadow; out[4 * i + 3] = at.widen;
}
)";

FibreRecipe migrating() {
  FibreRecipe recipe = fibre_recipe({});
  recipe.migration_min = 0.75;
  return recipe;
}

class FibreDetailKernel : public ::testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Precision, FibreDetailKernel, ::testing::Bool(),
                         [](const auto& i) { return i.param ? "Double" : "Float"; });

TEST_P(FibreDetailKernel, AgreesWithReference) {
  if (GetParam() && !Device::open().traits().fp64) GTEST_SKIP() << "the device has no fp64";
  const KernelRunner runner(kKernel, GetParam());
  constexpr double kRadius = 1.3e-4;
  constexpr size_t kCount = 40000;
  for (FibreRecipe recipe : {fibre_recipe({}), migrating()}) {
    FibreTables tables;
    tables.add(fibre_recipe({}), kRadius, Detail::maps);  // another material comes first
    tables.add(recipe, kRadius, Detail::maps);
    // A whole number of turns and of migrations fits the period in which lengths wrap.
    recipe.migration_rate = double(tables.details[1].wander) / double(tables.details[1].turns);
    const FibreDetail reference(recipe);
    Random random(5);
    std::vector<float> in;
    for (size_t i = 0; i < kCount; ++i) {
      in.push_back(float((2 * random.uniform_float() - 1) * std::numbers::pi));
      in.push_back(float(random.uniform_float() * W_LENGTH_PERIOD * kRadius));
    }
    const auto out = runner.run("fibre_at", kCount, 4, runner.upload<WFibreDetail>({tables.details[1]}),
                                runner.upload(tables.offsets), runner.upload(tables.candidates), runner.upload(in));
    size_t other = 0;
    double worst = 0;
    for (size_t i = 0; i < kCount; ++i) {
      // theta and the migration's angle as a whole number of turns per period
      const double length = in[2 * i + 1], theta = 2 * std::numbers::pi * double(tables.details[1].turns) * length;
      const FibreDetail::At at = reference.at(in[2 * i], theta);
      const double error = std::abs(out[4 * i] - at.sin_turn) + std::abs(out[4 * i + 2] - at.openness);
      if (error > 0.02)
        ++other;  // on the border of two fibres, rounding decides
      else
        worst = std::max(worst, error);
      EXPECT_NEAR(out[4 * i + 3], out[4 * i + 2] / reference.mean_openness(), 1e-3);
    }
    RecordProperty("on_borders", int(other));
    EXPECT_LE(other, kCount / 500);
    EXPECT_LT(worst, 0.02);
  }
}

TEST(FibreDetail, MeansAreTheMeans) {
  for (const FibreRecipe& recipe : {fibre_recipe({}), migrating()}) {
    const FibreDetail detail(recipe);
    Random random(8);
    double openness = 0, distance = 0, turn = 0;
    constexpr int kCount = 200000;
    for (int i = 0; i < kCount; ++i) {
      const auto at = detail.at(2 * std::numbers::pi * random.uniform_float(), 4000 * random.uniform_float());
      openness += at.openness / kCount;
      distance += at.distance / kCount;
      turn += at.sin_turn / kCount;
    }
    EXPECT_NEAR(openness / detail.mean_openness(), 1, 0.01);
    EXPECT_NEAR(distance / detail.mean_distance(), 1, 0.01);
    EXPECT_NEAR(turn, 0, 0.03);  // normals lean both ways
  }
}

// Bins only save time: the outermost fibre of all is the one that a bin knows.
TEST(FibreDetail, BinsMissNoFibre) {
  const FibreRecipe recipe = migrating();
  const FibreDetail detail(recipe);
  Random random(9);
  for (int i = 0; i < 20000; ++i) {
    const double phi = 2 * std::numbers::pi * random.uniform_float(), theta = 300 * random.uniform_float();
    double outermost = 0;
    for (const auto& f : detail.section().fibres) {
      const double d = fibre_distance(f, recipe, theta), off = phi - theta - f.angle;
      const double across = d * std::sin(off), rest = detail.fibre_radius() * detail.fibre_radius() - across * across;
      if (rest > 0) outermost = std::max(outermost, d * std::cos(off) + std::sqrt(rest));
    }
    EXPECT_NEAR(detail.at(phi, theta).radius, outermost, 1e-9);
  }
}

TEST(FibreDetail, FilterFadesToTheMean) {
  const KernelRunner runner(kKernel, false);
  FibreTables tables;
  tables.add(fibre_recipe({}), 1e-4, Detail::maps);
  const auto& m = tables.details[0];
  const auto out =
      runner.run("filtered", 3, 4, runner.upload<WFibreDetail>({m}), runner.upload<float>({0.4f, 1.2f, 2.5f}));
  EXPECT_NEAR(out[0], 0.7, 1e-6);
  EXPECT_NEAR(out[2], 0.2, 1e-6);
  EXPECT_NEAR(out[3], 0, 1e-9);
  EXPECT_GT(out[4], 0);
  EXPECT_LT(out[4], 0.7);
  EXPECT_NEAR(out[8], 0, 1e-9);
  EXPECT_NEAR(out[9], m.twist * m.mean_distance, 1e-6);
  EXPECT_NEAR(out[10], 1, 1e-6);
  EXPECT_NEAR(out[11], m.tilt_variance, 1e-9);
}

}  // namespace
}  // namespace wale
