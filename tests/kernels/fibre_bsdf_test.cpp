// The scattering of a single fibre: against a double oracle by angles, energies, normalisation, samples.
#include <gtest/gtest.h>

#include <numbers>

#include "host/materials.h"
#include "tests/kernels/appearance_oracle.h"
#include "tests/kernels/ply_kernels.h"
#include "tests/kernels/statistics.h"
#include "tests/tolerances.h"

namespace wale {
namespace {
using namespace test;

constexpr double kPi = std::numbers::pi;

const char* kKernels = R"(
#include "appearance/fibre_bsdf.clh"
static inline w_real3 vec(__global const float* p) { return (w_real3)(p[0], p[1], p[2]); }
static inline WFibreShade shade_of(__global const WFibreMaterial* m, __global const float* p) {
  return w_fibre_setup(*m, normalize(vec(p)), normalize(vec(p + 3)), normalize(vec(p + 6)));
}
/* For t, n, wv, w: 2 x 3 energies, 2 probabilities, 2 densities, sum rgb, density of the mixture */
__kernel void evaluate(__global const WFibreMaterial* m, __global const float* in, __global w_real* out, uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  const WFibreShade s = shade_of(m, in + 12 * i);
  const w_real3 w = normalize(vec(in + 12 * i + 9));
  __global w_real* o = out + 14 * i;
  for (int k = 0; k < 2; ++k) {
    vstore3(s.a[k], k, o);
    o[6 + k] = s.q[k];
    o[8 + k] = w_fibre_pdf(&s, k, w);
  }
  w_real pdf;
  vstore3(w_fibre_eval(&s, w, &pdf), 0, o + 10);
  o[13] = pdf;
}
/* Density times cos theta on an n x n grid of theta and azimuth about z. */
__kernel void density(__global const WFibreMaterial* m, __global const float* in, int lobe, uint n,
                      __global w_real* out, uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  const WFibreShade s = shade_of(m, in);
  const w_real theta = W_PI * (((i / n) + R(0.5)) / n - R(0.5)), phi = R(2.0) * W_PI * ((i % n) + R(0.5)) / n;
  const w_real r = cos(theta);
  out[i] = r * w_fibre_pdf(&s, lobe, (w_real3)(r * cos(phi), r * sin(phi), sin(theta)));
}
/* 5 numbers: choice, direction -> lobe, left, direction, density of the mixture, weight rgb */
__kernel void samples(__global const WFibreMaterial* m, __global const float* in, uint step, __global const float* u,
                      int fixed_lobe, __global w_real* out, uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  const WFibreShade s = shade_of(m, in + step * i);
  w_real left, pdf;
  const int chosen = w_fibre_choose(&s, u[5 * i], &left), lobe = fixed_lobe < 0 ? chosen : fixed_lobe;
  const w_real3 w = w_fibre_sample(&s, lobe, u[5 * i + 1], u[5 * i + 2], u[5 * i + 3], u[5 * i + 4]);
  const w_real3 f = w_fibre_eval(&s, w, &pdf), weight = s.a[chosen] / s.q[chosen];
  out[9 * i] = chosen;
  out[9 * i + 1] = left;
  vstore3(w, 0, out + 9 * i + 2);
  out[9 * i + 5] = pdf;
  vstore3(weight, 0, out + 9 * i + 6);
}
)";

/// The same from its formulas, by angles and in double.
struct Oracle {
  dvec3 energy[2];
  double density[2];

  Oracle(const WFibreMaterial& m, dvec3 t, dvec3 n, dvec3 wv, dvec3 w) {
    const double theta_v = std::asin(std::clamp(glm::dot(wv, t), -1.0, 1.0));
    const double theta = std::asin(std::clamp(glm::dot(w, t), -1.0, 1.0));
    const dvec3 x = std::abs(glm::dot(wv, t)) > 0.9999 ? glm::normalize(n - glm::dot(n, t) * t)
                                                       : glm::normalize(wv - glm::dot(wv, t) * t);
    const double phi = std::atan2(glm::dot(w, glm::cross(t, x)), glm::dot(w, x));
    const double f0[3] = {m.reflect.x, m.reflect.y, m.reflect.z}, c[3] = {m.transmit.x, m.transmit.y, m.transmit.z};
    for (int k = 0; k < 3; ++k) {
      const double f = f0[k] + (1 - f0[k]) * std::pow(1 - std::cos(theta_v), 5);
      energy[0][k] = f;
      energy[1][k] = (1 - f) * c[k];
    }
    const double g = m.gamma_tt, d = std::remainder(phi - kPi, 2 * kPi);
    const double inside = std::erf(kPi / (g * std::sqrt(2.0)));
    density[0] = oracle_longitudinal(theta_v, theta, double(m.beta_r) * m.beta_r) / (2 * kPi);
    density[1] = oracle_longitudinal(theta_v, theta, double(m.beta_tt) * m.beta_tt) *
                 (std::exp(-d * d / (2 * g * g)) / (g * std::sqrt(2 * kPi)) + (1 - inside) / (2 * kPi));
  }
};

WFibreMaterial material(float beta_r, float beta_tt, float gamma, w_float4 reflect, w_float4 transmit) {
  return {reflect, transmit, beta_r, beta_tt, gamma, 0};
}

std::vector<WFibreMaterial> materials() {
  std::vector<WFibreMaterial> all;
  for (const std::string& name : ply_presets()) {
    PlyAppearance a;
    a.preset = name;
    all.push_back(fibre_material(a));
  }
  // Zhao et al. 2016, Table 3: Cotton 2; and lobes so wide that their tails count.
  all.push_back(material(0.0175f, 0.47f, 0.66f, {.1f, .1f, .05f, 0}, {.93f, .53f, .01f, 0}));
  all.push_back(material(0.8f, 1.0f, 2.0f, {.3f, .6f, .9f, 0}, {.2f, .5f, .8f, 0}));
  return all;
}

std::vector<float> uniforms(size_t count, uint32_t seed) {
  Random random(seed);
  std::vector<float> u(count);
  for (float& v : u) v = random.uniform_float();
  return u;
}

class FibreBsdf : public ::testing::TestWithParam<bool> {
 protected:
  void SetUp() override {
    if (GetParam() && !Device::open().traits().fp64) GTEST_SKIP() << "the device has no fp64";
  }
};
INSTANTIATE_TEST_SUITE_P(Precision, FibreBsdf, ::testing::Bool(),
                         [](const auto& i) { return i.param ? "Double" : "Float"; });

TEST_P(FibreBsdf, AgreesWithOracle) {
  const KernelRunner runner(kKernels, GetParam());
  constexpr size_t kCount = 4096;
  Random random(12);
  std::vector<float> in;
  for (size_t i = 0; i < 4 * kCount; ++i) append(&in, random.direction());
  const auto buffer = runner.upload(in);
  for (const WFibreMaterial& m : materials()) {
    // Angles to 1e-7 over the variance: 1 degree is narrower than the lobes that kBsdfFloat stands for.
    const double narrow = 1e-7 / (double(m.beta_r) * m.beta_r);
    const double bound = GetParam() ? tolerance::kBsdfDouble : std::max(tolerance::kBsdfFloat, narrow);
    const auto out = runner.run("evaluate", kCount, 14, runner.upload<WFibreMaterial>({m}), buffer);
    double worst = 0, worst_energy = 0, worst_sum = 0;
    for (size_t i = 0; i < kCount; ++i) {
      const float* p = &in[12 * i];
      const double* o = &out[14 * i];
      const Oracle oracle(m, unit(p), unit(p + 3), unit(p + 6), unit(p + 9));
      for (int lobe = 0; lobe < 2; ++lobe) {
        worst = std::max(worst, std::abs(o[8 + lobe] - oracle.density[lobe]) / (oracle.density[lobe] + 1e-3));
        for (int k = 0; k < 3; ++k)
          worst_energy = std::max(worst_energy, std::abs(o[3 * lobe + k] - oracle.energy[lobe][k]));
      }
      for (int k = 0; k < 4; ++k) {
        double sum = 0;
        for (int lobe = 0; lobe < 2; ++lobe)
          sum += (k < 3 ? oracle.energy[lobe][k] : o[6 + lobe]) * oracle.density[lobe];
        worst_sum = std::max(worst_sum, std::abs(o[10 + k] - sum) / (sum + 1e-3));
      }
      EXPECT_NEAR(o[6] + o[7], 1, tolerance::kFurnace);
    }
    EXPECT_LT(worst, bound) << m.beta_r << " " << m.gamma_tt;
    EXPECT_LT(worst_sum, 2 * bound) << m.beta_r << " " << m.gamma_tt;
    EXPECT_LT(worst_energy, GetParam() ? tolerance::kEnergyDouble : tolerance::kFurnace);
  }
}

TEST_P(FibreBsdf, WhiteFibresLoseNothing) {
  const KernelRunner runner(kKernels, GetParam());
  constexpr size_t kCount = 4096;
  Random random(5);
  std::vector<float> in;
  for (size_t i = 0; i < 4 * kCount; ++i) append(&in, random.direction());
  const auto m = material(0.1f, 0.3f, 0.5f, {.02f, .3f, 1, 0}, {1, 1, 1, 0});
  const auto out = runner.run("evaluate", kCount, 14, runner.upload<WFibreMaterial>({m}), runner.upload(in));
  double worst = 0;
  for (size_t i = 0; i < kCount; ++i)
    for (int k = 0; k < 3; ++k) worst = std::max(worst, std::abs(out[14 * i + k] + out[14 * i + 3 + k] - 1));
  EXPECT_LE(worst, tolerance::kFurnace);
}

TEST_P(FibreBsdf, LobesIntegrateToOne) {
  const KernelRunner runner(kKernels, GetParam());
  const cl_uint n = 384;
  for (const WFibreMaterial& material : materials()) {
    if (material.beta_r < 0.04f) continue;  // narrower than the grid resolves
    const auto m = runner.upload<WFibreMaterial>({material});
    for (const double theta : {0.0, 0.8, -1.4}) {
      const auto view = runner.upload(floats(ply_view(0.3, theta)));
      for (cl_int lobe = 0; lobe < 2; ++lobe) {
        double sum = 0;
        for (const double p : runner.run("density", size_t(n) * n, 1, m, view, lobe, n)) sum += p;
        EXPECT_NEAR(sum * 2 * kPi * kPi / (double(n) * n), 1, tolerance::kPdfIntegral)
            << "lobe " << lobe << " theta " << theta << " beta " << material.beta_r;
      }
    }
  }
}

constexpr int kBins = 24, kSub = 16;

TEST(FibreSampling, FollowsDensity) {
  const KernelRunner runner(kKernels, false);
  constexpr size_t kCount = 400000;
  constexpr cl_uint n = kBins * kSub;
  const auto u = runner.upload(uniforms(5 * kCount, 71));
  std::vector<WFibreMaterial> all = materials();
  all.erase(std::remove_if(all.begin(), all.end(), [](const auto& m) { return m.beta_r < 0.04f; }), all.end());
  const double thetas[] = {0, 0.7, -1.3};
  const double p_min = tolerance::kFamilyP / (2.0 * double(all.size()));
  for (size_t c = 0; c < all.size(); ++c) {
    const auto m = runner.upload<WFibreMaterial>({all[c]});
    const auto view = runner.upload(floats(ply_view(0.2, thetas[c % 3])));
    for (cl_int lobe = 0; lobe < 2; ++lobe) {
      const auto grid = runner.run("density", size_t(n) * n, 1, m, view, lobe, n);
      std::vector<double> expected(kBins * kBins, 0), counts(kBins * kBins, 0);
      double total = 0;
      for (size_t i = 0; i < grid.size(); ++i) {
        expected[(i / n / kSub) * kBins + (i % n) / kSub] += grid[i];
        total += grid[i];
      }
      for (double& e : expected) e *= kCount / total;
      const auto out = runner.run("samples", kCount, 9, m, view, cl_uint(0), u, lobe);
      for (size_t i = 0; i < kCount; ++i) {
        const double* w = &out[9 * i + 2];
        const double phi = std::atan2(w[1], w[0]), around = (phi < 0 ? phi + 2 * kPi : phi) / (2 * kPi);
        const double along = std::asin(std::clamp(w[2], -1.0, 1.0)) / kPi + 0.5;
        counts[std::clamp(int(along * kBins), 0, kBins - 1) * kBins + std::clamp(int(around * kBins), 0, kBins - 1)] +=
            1;
      }
      EXPECT_GT(chi_squared_p(counts, expected), p_min) << "material " << c << " lobe " << lobe;
    }
  }
}

TEST(FibreSampling, ChoosesLobesByTheirProbability) {
  const KernelRunner runner(kKernels, false);
  constexpr size_t kCount = 100000;
  const auto m = material(0.1f, 0.3f, 0.5f, {.3f, .2f, .1f, 0}, {.9f, .2f, .1f, 0});
  const auto buffer = runner.upload<WFibreMaterial>({m});
  std::vector<float> view = floats(ply_view(0.6, 0.3));
  const auto out = runner.run("samples", kCount, 9, buffer, runner.upload(view), cl_uint(0),
                              runner.upload(uniforms(5 * kCount, 3)), cl_int(-1));
  view.insert(view.end(), {1, 0, 0});
  const auto shade = runner.run("evaluate", 1, 14, buffer, runner.upload(view));
  std::vector<double> counts(2, 0), left(16, 0);
  dvec3 mean(0);
  for (size_t i = 0; i < kCount; ++i) {
    counts[size_t(out[9 * i])] += 1;
    left[size_t(out[9 * i + 1] * 16)] += 1;
    mean += dvec3(out[9 * i + 6], out[9 * i + 7], out[9 * i + 8]) / double(kCount);
  }
  EXPECT_GT(chi_squared_p(counts, {shade[6] * kCount, shade[7] * kCount}), tolerance::kFamilyP);
  EXPECT_GT(chi_squared_p(left, std::vector<double>(16, kCount / 16.0)), tolerance::kFamilyP);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(mean[k], shade[k] + shade[3 + k], 0.01);
}

TEST(FibreSampling, StaysFiniteAtEveryExtreme) {
  const KernelRunner runner(kKernels, false);
  std::vector<std::array<dvec3, 3>> views;
  for (const double theta : {0.0, 1e-9, 1.0, 1.5566, 1.5707, kPi / 2, -kPi / 2}) views.push_back(ply_view(0.4, theta));
  views.push_back({dvec3(0, 0, 1), dvec3(0, 0, 1), dvec3(0, 0, -1)});
  const std::vector<float> ends = {0, 0x1p-24f, 0.5f, 1 - 0x1p-24f};
  std::vector<float> in, u;
  for (const auto& view : views)
    for (const float a : ends)
      for (const float b : ends)
        for (const float c : ends)
          for (const float d : ends) {
            const auto f = floats(view);
            in.insert(in.end(), f.begin(), f.end());
            u.insert(u.end(), {(a + b) / 2, a, b, c, d});
          }
  const size_t count = u.size() / 5;
  const auto in_buffer = runner.upload(in), u_buffer = runner.upload(u);
  for (const float width : {0.001f, 0.2f, 1.5f})
    for (const float colour : {0.0f, 1.0f}) {
      const auto m = material(width, width, width, {.04f, .04f, .04f, 0}, {colour, colour, colour, 0});
      for (cl_int lobe = 0; lobe < 2; ++lobe) {
        const auto out =
            runner.run("samples", count, 9, runner.upload<WFibreMaterial>({m}), in_buffer, cl_uint(9), u_buffer, lobe);
        size_t bad = 0;
        for (size_t i = 0; i < count; ++i) {
          const double* o = &out[9 * i];
          bool good = o[5] >= 0 && std::abs(glm::length(dvec3(o[2], o[3], o[4])) - 1) < 1e-5;
          for (int k = 0; k < 9; ++k) good = good && std::isfinite(o[k]);
          for (int k = 6; k < 9; ++k) good = good && o[k] >= 0 && o[k] <= 1.00001;
          bad += !good || !(o[1] >= 0 && o[1] < 1);
        }
        EXPECT_EQ(bad, 0u) << "width " << width << " colour " << colour << " lobe " << lobe;
      }
    }
}

}  // namespace
}  // namespace wale
