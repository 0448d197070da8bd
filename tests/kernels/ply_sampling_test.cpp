// Samples of the ply BSDF follow its densities, and stay finite where parameters and geometry are extreme.
#include <gtest/gtest.h>

#include "host/materials.h"
#include "tests/kernels/ply_kernels.h"
#include "tests/kernels/statistics.h"
#include "tests/tolerances.h"

namespace wale {
namespace {
using namespace test;

constexpr int kBins = 24, kSub = 48;  // fine: at the body's axis, which is no pole of this grid, azimuths turn fast

std::vector<float> uniforms(size_t count, uint32_t seed) {
  Random random(seed);
  std::vector<float> u(4 * count);
  for (float& v : u) v = random.uniform_float();
  return u;
}

int bin(double z, double y, double x) {
  const double phi = std::atan2(y, x), around = (phi < 0 ? phi + 2 * M_PI : phi) / (2 * M_PI);
  return std::clamp(int((z + 1) / 2 * kBins), 0, kBins - 1) * kBins + std::clamp(int(around * kBins), 0, kBins - 1);
}

// The measured lobes, the papers' Lambert lobes, and both with fibre detail.
class PlySamplingOf : public ::testing::TestWithParam<const char*> {};
std::string lobes_name(const ::testing::TestParamInfo<const char*>& info) {
  const std::vector<std::string> names = {"Full", "Paper", "FullDetail", "PaperDetail"};
  return names[info.index];
}
INSTANTIATE_TEST_SUITE_P(Lobes, PlySamplingOf,
                         ::testing::Values("", "-DW_PAPER_LOBES", "-DW_TEST_DETAIL", "-DW_PAPER_LOBES -DW_TEST_DETAIL"),
                         lobes_name);

TEST_P(PlySamplingOf, FollowsDensity) {
  const KernelRunner runner(kPlyKernels, false, GetParam());
  constexpr size_t kCount = 400000;
  constexpr cl_uint n = kBins * kSub;
  const auto u = runner.upload(uniforms(kCount, 77));
  struct Case {
    const char* preset;
    double h, theta;
  };
  const std::vector<Case> cases = {
      {"cotton", 0, 0}, {"wool", 0.5, 0.8}, {"silk", -0.9, -0.4}, {"polyester", 0.97, 1.3}};
  const double p_min = tolerance::kFamilyP / (3 * cases.size());
  for (const Case& c : cases) {
    PlyAppearance a;
    a.preset = c.preset;
    const auto m = runner.upload<WPlyMaterial>({ply_material(a)});
    const auto view = runner.upload(floats(ply_view(c.h, c.theta)));
    for (cl_int lobe = 0; lobe < 3; ++lobe) {
      const auto grid = runner.run("density_grid", size_t(n) * n, 1, m, view, lobe, n);
      std::vector<double> expected(kBins * kBins, 0), counts(kBins * kBins, 0);
      double total = 0;
      for (size_t i = 0; i < grid.size(); ++i) {
        expected[(i / n / kSub) * kBins + (i % n) / kSub] += grid[i];
        total += grid[i];
      }
      // A narrow highlight and a Lambert lobe's edge are worst for the midpoint rule.
      EXPECT_NEAR(total * 4 * M_PI / (double(n) * n), 1, 2e-3);
      for (double& e : expected) e *= kCount / total;
      const auto out = runner.run("samples", kCount, 9, m, view, cl_uint(0), u, lobe);
      for (size_t i = 0; i < kCount; ++i) counts[bin(out[9 * i + 3], out[9 * i + 2], out[9 * i + 1])] += 1;
      EXPECT_GT(chi_squared_p(counts, expected), p_min) << c.preset << " lobe " << lobe;
    }
  }
}

TEST(PlySampling, ChoosesLobesByTheirProbability) {
  const KernelRunner runner(kPlyKernels, false);
  constexpr size_t kCount = 100000;
  PlyAppearance a;
  a.color = Rgb{0.9, 0.2, 0.1};
  const auto m = runner.upload<WPlyMaterial>({ply_material(a)});
  const auto view = runner.upload(floats(ply_view(0.6, 0.3)));
  const auto energies = runner.run("energies", 1, 15, m, view);
  const auto out =
      runner.run("samples", kCount, 9, m, view, cl_uint(0), runner.upload(uniforms(kCount, 3)), cl_int(-1));
  std::vector<double> counts(3, 0), left(16, 0);
  dvec3 mean(0);
  for (size_t i = 0; i < kCount; ++i) {
    counts[int(out[9 * i])] += 1;
    left[int(out[9 * i + 8] * 16)] += 1;
    mean += dvec3(out[9 * i + 5], out[9 * i + 6], out[9 * i + 7]) / double(kCount);
  }
  const std::vector<double> expected = {energies[9] * kCount, energies[10] * kCount, energies[11] * kCount};
  EXPECT_GT(chi_squared_p(counts, expected), tolerance::kFamilyP);
  // What is left of the number is uniform again.
  EXPECT_GT(chi_squared_p(left, std::vector<double>(16, kCount / 16.0)), tolerance::kFamilyP);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(mean[k], energies[k] + energies[3 + k] + energies[6 + k], 0.01);
}

// Every extreme of the parameters with every extreme of the geometry.
class PlyExtremes : public ::testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Precision, PlyExtremes, ::testing::Bool(),
                         [](const auto& i) { return i.param ? "Double" : "Float"; });

TEST_P(PlyExtremes, StayFinite) {
  if (GetParam() && !Device::open().traits().fp64) GTEST_SKIP() << "the device has no fp64";
  const KernelRunner runner(kPlyKernels, GetParam());
  const double nearly = 1 - 1e-7;
  std::vector<std::array<dvec3, 3>> views;
  for (const double h : {-1.0, -nearly, 0.0, 1e-9, nearly, 1.0})
    for (const double theta : {0.0, 1e-9, 1.0, 1.5566, 1.57, 1.5707, M_PI / 2, -M_PI / 2})
      views.push_back(ply_view(h, theta));
  for (const dvec3 n : {dvec3(0, 0, 1), dvec3(0, 0, -1), dvec3(1e-8, 0, 1), dvec3(-1, 0, 0), dvec3(0, -1, 1e-4)})
    for (const dvec3 wv : {dvec3(0, 0, 1), dvec3(0, 0, -1), dvec3(1, 0, 0), dvec3(1e-4, 0, 1)})
      views.push_back({dvec3(0, 0, 1), n, wv});
  const std::vector<float> ends = {0, 0x1p-24f, 0.25f, 0.5f, 0.75f, 1 - 0x1p-24f};
  std::vector<float> in, u;
  for (const auto& view : views)
    for (const float a : ends)
      for (const float b : ends)
        for (const float c : ends) {
          const auto f = floats(view);
          in.insert(in.end(), f.begin(), f.end());
          u.insert(u.end(), {(a + b) / 2, a, b, c});
        }
  const size_t count = u.size() / 4;
  const auto in_buffer = runner.upload(in);
  const auto u_buffer = runner.upload(u);
  for (const double roughness : {0.001, 1.0})
    for (const double color : {0.0, 1.0})
      for (const double twist : {0.0, 1.4}) {
        PlyAppearance a;
        a.roughness = roughness;
        a.color = Rgb{color, color, color};
        a.fibre_twist = twist;
        const auto m = runner.upload<WPlyMaterial>({ply_material(a)});
        for (cl_int lobe = -1; lobe < 3; ++lobe) {
          const auto out = runner.run("samples", count, 9, m, in_buffer, cl_uint(9), u_buffer, lobe < 0 ? 0 : lobe);
          size_t bad = 0;
          for (size_t i = 0; i < count; ++i) {
            const double* o = &out[9 * i];
            bool good = o[4] >= 0 && std::abs(glm::length(dvec3(o[1], o[2], o[3])) - 1) < 1e-5;
            for (int k = 0; k < 9; ++k) good = good && std::isfinite(o[k]);
            for (int k = 5; k < 8; ++k) good = good && o[k] >= 0 && o[k] <= 1.00001;
            good = good && o[8] >= 0 && o[8] < 1;
            bad += !good;
          }
          EXPECT_EQ(bad, 0u) << "roughness " << roughness << " color " << color << " twist " << twist << " lobe "
                             << lobe;
        }
      }
}

// A lobe far narrower than any grid: the mean of 1/density over samples is the solid angle it covers.
TEST(PlySampling, NarrowLobeKeepsItsWidth) {
  const KernelRunner runner(kPlyKernels, false);
  PlyAppearance a;
  a.roughness = 0.001;
  a.fibre_twist = 0.0;
  constexpr size_t kCount = 100000;
  const double theta = 0.5;
  const auto out = runner.run("samples", kCount, 9, runner.upload<WPlyMaterial>({ply_material(a)}),
                              runner.upload(floats(ply_view(0.2, theta))), cl_uint(0),
                              runner.upload(uniforms(kCount, 8)), cl_int(0));
  double mean = 0, square = 0;
  for (size_t i = 0; i < kCount; ++i) {
    const double angle = std::asin(out[9 * i + 3]) + theta;
    mean += angle / kCount;
    square += angle * angle / kCount;
  }
  EXPECT_NEAR(mean, 0, 2e-5);
  EXPECT_NEAR(std::sqrt(square), 0.001, 2e-5);
}

}  // namespace
}  // namespace wale
