// Derivatives of the ply BSDF by what a fit changes: against differences of the double oracle.
#include <gtest/gtest.h>

#include "host/materials.h"
#include "tests/kernels/appearance_oracle.h"
#include "tests/kernels/ply_kernels.h"
#include "tests/kernels/statistics.h"

namespace wale {
namespace {
using namespace test;

// f, then its derivatives by W_GRADIENT_*; a configuration is 12 floats: t, n, wv, w.
const std::string kGradientKernels = std::string("#define W_GRADIENTS\n") + kPlyKernels + R"(
#include "appearance/ply_gradient.clh"
__kernel void gradients(__global const WPlyMaterial* m, __global const float* in, __global w_real* out, uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  __global const float* p = in + 12 * i;
  const w_v3 t = unit(p), n = unit(p + 3), wv = unit(p + 6), w = unit(p + 9);
  const WPlyMaterialLanes material = material_of(m);
  const WPlyShade s = w_ply_setup(&material, t, n, wv);
  const WPlyShade tilted = w_ply_setup_tilted(&material, t, n, wv, w_fibre_mean_lanes(material.tilt));
  w_vf pdf;
  const w_v3 f = w_ply_eval(&s, w, &pdf);
  const WPlyGradient g = w_ply_gradient(&s, &tilted, material.beta_r, w, f);
  vstore3(w_v3_lane(&f, 0), 0, out + 15 * i);
  for (int k = 0; k < W_GRADIENT_COUNT; ++k) vstore3(w_v3_lane(&g.d[k], 0), k + 1, out + 15 * i);
}
/* d ln M / dv and ln M for sin_i, sin_o, v. */
__kernel void slopes(__global const float* in, __global w_real* out, uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  const w_real si = in[3 * i], so = in[3 * i + 1];
  const WLongitudinal l = w_longitudinal_of(in[3 * i + 2]);
  out[i] = w_longitudinal_slope(si, sqrt((1 - si) * (1 + si)), so, sqrt((1 - so) * (1 + so)), &l);
}
)";

class PlyGradient : public ::testing::TestWithParam<bool> {
 protected:
  void SetUp() override {
    if (GetParam() && !Device::open().traits().fp64) GTEST_SKIP() << "the device has no fp64";
  }
};
INSTANTIATE_TEST_SUITE_P(Precision, PlyGradient, ::testing::Bool(),
                         [](const auto& i) { return i.param ? "Double" : "Float"; });

double log_longitudinal(double si, double so, double v) {
  const double ci = std::sqrt(1 - si * si), co = std::sqrt(1 - so * so), x = ci * co / v;
  // ln(exp(-x) I0(x)); beyond what I0 holds by its asymptotic series (Abramowitz & Stegun 9.7.1).
  double log_i0e = x < 600 ? std::log(std::cyl_bessel_i(0.0, x)) - x
                           : std::log1p(1 / (8 * x) + 9 / (128 * x * x)) - 0.5 * std::log(2 * M_PI * x);
  return -0.5 * ((ci - co) * (ci - co) + (si + so) * (si + so)) / v + log_i0e - std::log(v * -std::expm1(-2 / v));
}

TEST_P(PlyGradient, LongitudinalSlopeIsThatOfTheOracle) {
  const KernelRunner runner(kGradientKernels, GetParam());
  Random random(3);
  std::vector<float> in;
  for (int i = 0; i < 4000; ++i) {
    in.push_back(float(random.uniform(-0.999, 0.999)));
    // Where the lobe has most of its light, and everywhere.
    const double v = std::pow(10, random.uniform(-3.3, 1));
    in.push_back(float(i % 2 ? std::clamp(-in.back() + random.uniform(-3, 3) * std::sqrt(v), -0.999, 0.999)
                             : random.uniform(-0.999, 0.999)));
    in.push_back(float(v));
  }
  const auto out = runner.run("slopes", in.size() / 3, 1, runner.upload(in));
  double worst = 0;
  for (size_t i = 0; i < out.size(); ++i) {
    const double si = in[3 * i], so = in[3 * i + 1], v = in[3 * i + 2], step = 1e-4 * v;
    const double exact = (log_longitudinal(si, so, v + step) - log_longitudinal(si, so, v - step)) / (2 * step);
    worst = std::max(worst, std::abs(out[i] - exact) / (std::abs(exact) + 0.5 / v));
  }
  EXPECT_LT(worst, GetParam() ? 1e-4 : 2e-3);  // polynomials for Bessel's functions, and the difference itself
}

// By the body colours, the highlight's width and the tilt, of every preset.
TEST_P(PlyGradient, IsThatOfTheOracle) {
  const KernelRunner runner(kGradientKernels, GetParam());
  constexpr size_t kCount = 3000;
  for (const std::string& name : ply_presets()) {
    PlyAppearance a;
    a.preset = name;
    a.forward = Rgb{0.7, 0.5, 0.2};
    a.back = Rgb{0.3, 0.6, 0.8};
    const WPlyMaterial m = ply_material(a);
    Random random(17);
    std::vector<float> in;
    for (size_t i = 0; i < kCount; ++i) {
      const dvec3 t = random.direction(), wv = random.direction();
      dvec3 n = random.direction();
      n = glm::normalize(n - glm::dot(n, t) * t);
      append(&in, t);
      append(&in, glm::dot(n, wv) < 0 ? -n : n);
      append(&in, wv);
      append(&in, random.direction());
    }
    const auto out = runner.run("gradients", kCount, 15, runner.upload<WPlyMaterial>({m}), runner.upload(in));
    double worst[W_GRADIENT_COUNT] = {0, 0, 0, 0};
    for (size_t i = 0; i < kCount; ++i) {
      const float* p = &in[12 * i];
      const auto f = [&](const WPlyMaterial& with, int c) {
        const PlyOracle oracle(with, unit(p), unit(p + 3), unit(p + 6));
        double sum = 0;
        for (int lobe = 0; lobe < 3; ++lobe) sum += oracle.energy[lobe][c] * oracle.pdf(lobe, unit(p + 9));
        return sum;
      };
      for (int c = 0; c < 3; ++c) {
        // Along a step of one parameter, by the numbers that floats hold.
        const auto difference = [&](float WPlyMaterial::*member, float low, float high) {
          WPlyMaterial a0 = m, a1 = m;
          a0.*member = low, a1.*member = high;
          return (f(a1, c) - f(a0, c)) / (double(high) - double(low));
        };
        const auto color = [&](w_float4 WPlyMaterial::*member) {
          WPlyMaterial a0 = m, a1 = m;
          float* const low[] = {&(a0.*member).x, &(a0.*member).y, &(a0.*member).z};
          float* const high[] = {&(a1.*member).x, &(a1.*member).y, &(a1.*member).z};
          *low[c] -= 0.1f, *high[c] += 0.1f;
          return (f(a1, c) - f(a0, c)) / (double(*high[c]) - double(*low[c]));
        };
        const double exact[W_GRADIENT_COUNT] = {color(&WPlyMaterial::forward), color(&WPlyMaterial::back),
                                                difference(&WPlyMaterial::beta_r, m.beta_r * 0.999f, m.beta_r * 1.001f),
                                                difference(&WPlyMaterial::tilt, m.tilt, m.tilt + 0.002f)};
        const double value = f(m, c);
        for (int k = 0; k < W_GRADIENT_COUNT; ++k) {
          const double got = out[15 * i + 3 * (size_t(k) + 1) + size_t(c)];
          const double scale = std::abs(exact[k]) + value + 1e-3;
          worst[k] = std::max(worst[k], std::abs(got - exact[k]) / scale);
        }
        EXPECT_NEAR(out[15 * i + size_t(c)], value, 2e-4 * (value + 1e-3));
      }
    }
    const double bound = GetParam() ? 1e-4 : 1e-3;
    EXPECT_LT(worst[W_GRADIENT_TRANSMIT], bound) << name;
    EXPECT_LT(worst[W_GRADIENT_REFLECT], bound) << name;
    EXPECT_LT(worst[W_GRADIENT_ROUGHNESS], 5 * bound) << name;
    EXPECT_LT(worst[W_GRADIENT_TILT], GetParam() ? 2e-3 : 2e-2) << name;  // rounding over a step of 0.002
  }
}

}  // namespace
}  // namespace wale
