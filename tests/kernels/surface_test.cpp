// Surface materials: energy, reciprocity, samples against density, extremes.
#include <gtest/gtest.h>

#include "host/materials.h"
#include "tests/kernels/kernel_runner.h"
#include "tests/kernels/statistics.h"
#include "tests/tolerances.h"

namespace wale {
namespace {
using namespace test;

// The normal is a skew one, so that no axis is special.
const char* kKernels = R"(
#include "appearance/surface.clh"
static inline w_real3 vec(__global const float* p) { return (w_real3)(p[0], p[1], p[2]); }
/* v, l (6 floats, frame of the normal) -> f cos rgb, pdf; then the same with v and l exchanged */
static inline void frame(w_real3* x, w_real3* y, w_real3* n) {
  *n = normalize((w_real3)(R(0.3), R(-0.8), R(0.5)));
  *x = w_perpendicular(*n);
  *y = cross(*n, *x);
}
__kernel void evaluate(__global const WSurfaceMaterial* m, __global const float* in, __global w_real* out,
                       uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  w_real3 x, y, n;
  frame(&x, &y, &n);
  const w_real3 a = normalize(vec(in + 6 * i)), b = normalize(vec(in + 6 * i + 3));
  const w_real3 v = x * a.x + y * a.y + n * a.z, l = x * b.x + y * b.y + n * b.z;
  w_real pdf;
  vstore3(w_surface_eval(*m, n, v, l, &pdf), 0, out + 8 * i);
  out[8 * i + 3] = pdf;
  vstore3(w_surface_eval(*m, n, l, v, &pdf), 0, out + 8 * i + 4);
  out[8 * i + 7] = pdf;
}
/* One view (3 floats), 3 numbers a sample -> direction in the frame, pdf, weight rgb */
__kernel void samples(__global const WSurfaceMaterial* m, __global const float* view, __global const float* u,
                      __global w_real* out, uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  w_real3 x, y, n, wl;
  frame(&x, &y, &n);
  const w_real3 a = normalize(vec(view));
  w_real pdf;
  const w_real3 weight = w_surface_sample(*m, n, x * a.x + y * a.y + n * a.z, u[3 * i], u[3 * i + 1], u[3 * i + 2],
                                          &wl, &pdf);
  vstore3((w_real3)(dot(wl, x), dot(wl, y), dot(wl, n)), 0, out + 7 * i);
  out[7 * i + 3] = pdf;
  vstore3(weight, 0, out + 7 * i + 4);
}
)";

WSurfaceMaterial coated(double roughness, double ior, Rgb color) {
  SurfaceAppearance a;
  a.coated = true;
  a.roughness = roughness;
  a.ior = ior;
  a.color = color;
  return surface_material(a);
}

std::vector<float> view_at(double mu) { return {float(std::sqrt(1 - mu * mu)), 0, float(mu)}; }

std::vector<float> uniforms(size_t count, uint32_t seed) {
  Random random(seed);
  std::vector<float> u(count);
  for (float& v : u) v = random.uniform_float();
  return u;
}

TEST(Surface, WhiteFurnace) {
  const KernelRunner runner(kKernels, false);
  constexpr int kSide = 500;  // a regular grid in the numbers of each technique; u1 chooses it
  std::vector<float> u;
  for (int i = 0; i < kSide * kSide; ++i)
    for (const double value :
         {std::fmod((i + 0.5) * 0.6180339887498949, 1.0), (i % kSide + 0.5) / kSide, (i / kSide + 0.5) / kSide})
      u.push_back(float(value));
  const auto buffer = runner.upload(u);
  for (const double roughness : {0.05, 0.3, 0.6, 1.0})
    for (const double mu : {1.0, 0.7, 0.3, 0.1}) {
      const auto out =
          runner.run("samples", u.size() / 3, 7, runner.upload<WSurfaceMaterial>({coated(roughness, 1.5, {1, 1, 1})}),
                     runner.upload(view_at(mu)), buffer);
      double mean = 0;
      for (size_t i = 0; i < u.size() / 3; ++i) mean += out[7 * i + 4] / (kSide * kSide);
      EXPECT_NEAR(mean, 1, tolerance::kSurfaceFurnace) << "roughness " << roughness << " mu " << mu;
    }
}

TEST(Surface, Reciprocal) {
  const KernelRunner runner(kKernels, false);
  Random random(4);
  std::vector<float> in;
  constexpr size_t kCount = 2000;
  for (size_t i = 0; i < 2 * kCount; ++i) {
    const dvec3 w = random.direction();
    for (const double value : {w.x, w.y, std::abs(w.z) + 0.02}) in.push_back(float(value));
  }
  for (const double roughness : {0.3, 0.7, 1.0}) {
    const auto out =
        runner.run("evaluate", kCount, 8, runner.upload<WSurfaceMaterial>({coated(roughness, 1.7, {0.8, 0.4, 0.1})}),
                   runner.upload(in));
    double worst = 0;
    for (size_t i = 0; i < kCount; ++i) {
      const float* a = &in[6 * i];
      const double mu_v = a[2] / std::hypot(a[0], a[1], a[2]), mu_l = a[5] / std::hypot(a[3], a[4], a[5]);
      for (int k = 0; k < 3; ++k) {
        const double there = out[8 * i + k] / mu_l, back = out[8 * i + 4 + k] / mu_v;
        worst = std::max(worst, std::abs(there - back) / (there + 1e-6));
      }
    }
    EXPECT_LT(worst, tolerance::kReciprocity) << roughness;
  }
}

TEST(Surface, FloatAgreesWithDouble) {
  if (!Device::open().traits().fp64) GTEST_SKIP() << "the device has no fp64";
  const KernelRunner once(kKernels, false), twice(kKernels, true);
  Random random(14);
  std::vector<float> in;
  constexpr size_t kCount = 4000;
  for (size_t i = 0; i < 2 * kCount; ++i) {
    const dvec3 w = random.direction();
    for (const double value : {w.x, w.y, std::abs(w.z) + 0.02}) in.push_back(float(value));
  }
  for (const double roughness : {0.05, 0.3, 1.0}) {
    const std::vector<WSurfaceMaterial> m = {coated(roughness, 1.5, {0.8, 0.4, 0.1})};
    const auto a = once.run("evaluate", kCount, 8, once.upload(m), once.upload(in));
    const auto b = twice.run("evaluate", kCount, 8, twice.upload(m), twice.upload(in));
    double worst = 0;
    for (size_t i = 0; i < a.size(); ++i) worst = std::max(worst, std::abs(a[i] - b[i]) / (b[i] + 1e-3));
    EXPECT_LT(worst, tolerance::kSurfaceFloat) << roughness;
    EXPECT_GT(worst, 0) << "the double build ran in float";
  }
}

TEST(Surface, SamplesFollowDensity) {
  const KernelRunner runner(kKernels, false);
  constexpr size_t kCount = 400000;
  constexpr int kBins = 24, kSub = 24, kSide = kBins * kSub;
  const auto u = runner.upload(uniforms(3 * kCount, 9));
  std::vector<WSurfaceMaterial> materials = {coated(0.3, 1.5, {0.5, 0.5, 0.5}), coated(0.6, 1.3, {0.9, 0.9, 0.9}),
                                             coated(1.0, 2.5, {0, 0, 0}), surface_material(SurfaceAppearance{})};
  const std::vector<double> mus = {0.95, 0.4, 0.2};
  for (const WSurfaceMaterial& material : materials)
    for (const double mu : mus) {
      const auto m = runner.upload<WSurfaceMaterial>({material});
      const std::vector<float> v = view_at(mu);
      std::vector<float> in;
      for (int i = 0; i < kSide * kSide; ++i) {
        const double z = (i / kSide + 0.5) / kSide, phi = 2 * M_PI * (i % kSide + 0.5) / kSide;
        in.insert(in.end(), v.begin(), v.end());
        for (const double value : {std::sqrt(1 - z * z) * std::cos(phi), std::sqrt(1 - z * z) * std::sin(phi), z})
          in.push_back(float(value));
      }
      const auto density = runner.run("evaluate", size_t(kSide) * kSide, 8, m, runner.upload(in));
      std::vector<double> expected(kBins * kBins, 0), counts(kBins * kBins, 0);
      for (int i = 0; i < kSide * kSide; ++i)
        expected[(i / kSide / kSub) * kBins + i % kSide / kSub] +=
            density[8 * i + 3] * 2 * M_PI / (double(kSide) * kSide) * kCount;
      const auto out = runner.run("samples", kCount, 7, m, runner.upload(v), u);
      size_t alive = 0;
      for (size_t i = 0; i < kCount; ++i) {
        const double* o = &out[7 * i];
        if (!(o[3] > 0)) continue;  // went below the surface
        ++alive;
        const double phi = std::atan2(o[1], o[0]), around = (phi < 0 ? phi + 2 * M_PI : phi) / (2 * M_PI);
        counts[std::clamp(int(o[2] * kBins), 0, kBins - 1) * kBins + std::clamp(int(around * kBins), 0, kBins - 1)] +=
            1;
      }
      EXPECT_GT(chi_squared_p(counts, expected), tolerance::kFamilyP / (materials.size() * mus.size()))
          << "roughness " << material.roughness << " kind " << material.kind << " mu " << mu << " alive " << alive;
    }
}

TEST(Surface, ExtremesStayFinite) {
  const KernelRunner runner(kKernels, false);
  std::vector<float> u;
  const std::vector<float> ends = {0, 0x1p-24f, 0.3f, 0.5f, 1 - 0x1p-24f};
  for (const float a : ends)
    for (const float b : ends)
      for (const float c : ends) u.insert(u.end(), {a, b, c});
  for (float& v : uniforms(3000, 1)) u.push_back(v);
  const auto buffer = runner.upload(u);
  for (const double roughness : {0.0, 0.001, 1.0})
    for (const double color : {0.0, 1.0})
      for (const double ior : {1.0, 1.5, 3.0})
        for (const double mu : {1.0, 0.5, 1e-3, 1e-5, 1e-8, 0.0, -0.1}) {
          const auto m = runner.upload<WSurfaceMaterial>({coated(roughness, ior, {color, color, color})});
          const auto out = runner.run("samples", u.size() / 3, 7, m, runner.upload(view_at(mu)), buffer);
          size_t bad = 0;
          for (size_t i = 0; i < u.size() / 3; ++i) {
            bool good = out[7 * i + 3] >= 0;
            for (int k = 0; k < 7; ++k) good = good && std::isfinite(out[7 * i + k]);
            for (int k = 4; k < 7; ++k) good = good && out[7 * i + k] >= 0 && out[7 * i + k] < 12;
            bad += !good;
          }
          EXPECT_EQ(bad, 0u) << "roughness " << roughness << " color " << color << " ior " << ior << " mu " << mu;
        }
}

}  // namespace
}  // namespace wale
