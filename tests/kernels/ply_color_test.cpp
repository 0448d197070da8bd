// Colours that vary as words, and the colour of thick cloth against what the ply BSDF does.
#include <gtest/gtest.h>

#include "host/materials.h"
#include "host/ply_colors.h"
#include "host/scattering_keys.h"
#include "host/thick_layer.h"
#include "tests/kernels/appearance_oracle.h"
#include "tests/kernels/ply_kernels.h"
#include "tests/kernels/statistics.h"
#include "tests/tolerances.h"

namespace wale {
namespace {
using namespace test;

const char* kColorKernels = R"(
#include "appearance/ply_color.clh"
__kernel void decode(__global const uint* words, __global w_real* out, uint count) {
  const uint i = get_global_id(0);
  if (i < count) vstore3(w_ply_color(words[i]), 0, out + 3 * i);
}
/* fibre rgb, forward rgb, back rgb of the material of a segment with this word */
__kernel void colored(__global const WPlyMaterial* m, __global const uint* words, __global w_real* out, uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  const WPlyMaterial c = w_ply_colored(*m, words[i]);
  for (int k = 0; k < 3; ++k) {
    out[9 * i + k] = k == 0 ? c.fibre.x : k == 1 ? c.fibre.y : c.fibre.z;
    out[9 * i + 3 + k] = k == 0 ? c.forward.x : k == 1 ? c.forward.y : c.forward.z;
    out[9 * i + 6 + k] = k == 0 ? c.back.x : k == 1 ? c.back.y : c.back.z;
  }
})";

TEST(PlyColor, EveryCodeIsReadAsItIsMeant) {
  for (const bool fp64 : {false, true}) {
    if (fp64 && !Device::open().traits().fp64) continue;
    const KernelRunner runner(kColorKernels, fp64);
    std::vector<cl_uint> words;
    for (cl_uint q = 0; q < 1024; ++q) words.push_back(W_COLOR_GIVEN | q | ((q * 7) % 1024) << 10 | (1023 - q) << 20);
    const auto out = runner.run("decode", words.size(), 3, runner.upload<cl_uint>(words));
    for (size_t i = 0; i < words.size(); ++i) {
      const Rgb exact = unpack_ply_color(words[i]);
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(out[3 * i + k], exact[k], fp64 ? 1e-15 : 2e-7) << i;
    }
    EXPECT_EQ(out[0], 0);
    EXPECT_EQ(out[2], 1);
    EXPECT_EQ(out[3 * 1023], 1) << "white must be exactly white";
  }
}

TEST(PlyColor, ReplacesFibresOrTintsBodies) {
  const KernelRunner runner(kColorKernels, false);
  const Rgb tint{0.25, 1, 0.64};
  const std::vector<cl_uint> words = {0, pack_ply_color(tint)};
  PlyAppearance fibres;
  fibres.fibre_color = Rgb{0.9, 0.8, 0.7};
  const auto f =
      runner.run("colored", 2, 9, runner.upload<WPlyMaterial>({ply_material(fibres)}), runner.upload<cl_uint>(words));
  PlyAppearance bodies;
  bodies.forward = Rgb{0.5, 0.6, 0.7};
  bodies.back = Rgb{0.2, 0.3, 0.4};
  const auto b =
      runner.run("colored", 2, 9, runner.upload<WPlyMaterial>({ply_material(bodies)}), runner.upload<cl_uint>(words));
  for (int k = 0; k < 3; ++k) {
    EXPECT_FLOAT_EQ(float(f[k]), float((*fibres.fibre_color)[k])) << "no word, no change";
    EXPECT_FLOAT_EQ(float(b[3 + k]), float((*bodies.forward)[k]));
    EXPECT_NEAR(f[9 + k], tint[k], 1.0 / 1023);
    EXPECT_NEAR(b[12 + k], tint[k] * (*bodies.forward)[k], 1.0 / 1023);
    EXPECT_NEAR(b[15 + k], tint[k] * (*bodies.back)[k], 1.0 / 1023);
  }
}

// Places and angles at which an isotropic field collides with a ply, drawn at random.
std::vector<float> collisions(size_t count, double tau, uint32_t seed) {
  Random random(seed);
  std::vector<float> out;
  while (out.size() < 9 * count) {
    const double h = random.uniform(-1, 1), theta = random.uniform(-M_PI / 2, M_PI / 2);
    const double keep = std::cos(theta) * std::cos(theta) * (1 - std::exp(-2 * tau * std::sqrt(1 - h * h)));
    if (random.uniform(0, 1) > keep) continue;
    for (const dvec3& v : ply_view(h, theta)) append(&out, v);
  }
  return out;
}

// A and g of the thick layer are means over the scattering that the kernels do.
TEST(ThickLayer, AveragesAreThoseOfTheKernels) {
  const KernelRunner runner(kPlyKernels, false);
  constexpr size_t kCount = 200000;
  for (const std::string& name : ply_presets()) {
    PlyAppearance a;
    a.preset = name;
    a.fibre_color = Rgb{1, 1, 1};
    const WPlyMaterial white = ply_material(a);
    const auto in = collisions(kCount, white.tau_e, 21);
    Random random(22);
    std::vector<float> u;
    for (size_t i = 0; i < 4 * kCount; ++i) u.push_back(float(random.uniform(0, 1)));
    const auto out = runner.run("samples", kCount, 9, runner.upload<WPlyMaterial>({white}), runner.upload(in),
                                cl_uint(9), runner.upload(u), cl_int(-1));
    double cosine = 0;
    for (size_t i = 0; i < kCount; ++i)
      cosine -= glm::dot(dvec3(out[9 * i + 1], out[9 * i + 2], out[9 * i + 3]), unit(&in[9 * i + 6])) / kCount;
    EXPECT_NEAR(ThickLayer(white).mean_cosine(1), cosine, 0.006) << name;  // 3.5 standard errors of +-0.75

    for (const double color : {0.0, 0.5, 0.9, 0.99}) {
      a.fibre_color = Rgb{color, color, color};
      const WPlyMaterial dyed = ply_material(a);
      double albedo = 0, square = 0;
      constexpr size_t kViews = 20000;
      for (size_t i = 0; i < kViews; ++i) {
        const float* p = &in[9 * i];
        const PlyOracle oracle(dyed, unit(p), unit(p + 3), unit(p + 6));
        const double sum = oracle.energy[0].x + oracle.energy[1].x + oracle.energy[2].x;
        albedo += sum / kViews;
        square += sum * sum / kViews;
      }
      const double error = std::sqrt(std::max(0.0, square - albedo * albedo) / kViews);
      EXPECT_NEAR(ThickLayer(dyed).albedo(color), albedo, 4 * error + 1e-3) << name << " " << color;
    }
  }
}

// Every fitted parameter at the ends of what a scene may give: finite, nothing lost, nothing won.
TEST(PlyColor, ExtremeParametersKeepTheFurnace) {
  const KernelRunner runner(kPlyKernels, false);
  constexpr size_t kViews = 512;
  const std::vector<float> in = collisions(kViews, 3, 5);
  Random random(6);
  std::vector<float> u;
  for (size_t i = 0; i < 4 * kViews; ++i) u.push_back(float(random.uniform(0, 1)));
  const auto views = runner.upload(in);
  const auto numbers = runner.upload(u);
  for (const ScatteringKey& key : kScatteringKeys)
    for (const double end : {key.low, key.high})
      for (const double color : {0.0, 1.0})
        for (const double roughness : {0.001, 1.0}) {
          PlyAppearance a;
          a.fibre_color = Rgb{color, color, color};
          a.roughness = roughness;
          a.scattering.*key.given = end * (key.angle ? M_PI / 180 : 1);
          const auto m = runner.upload<WPlyMaterial>({ply_material(a)});
          const auto energy = runner.run("energies", kViews, 15, m, views);
          const auto sample = runner.run("samples", kViews, 9, m, views, cl_uint(9), numbers, cl_int(-1));
          size_t bad = 0;
          for (size_t i = 0; i < kViews; ++i) {
            const double* e = &energy[15 * i];
            const double sum = e[0] + e[3] + e[6];
            bad += !(color == 1 ? std::abs(sum - 1) <= tolerance::kFurnace : sum >= 0 && sum <= 1);
            for (int k = 0; k < 9; ++k) bad += !std::isfinite(sample[9 * i + k]);
            bad += !(std::abs(glm::length(dvec3(sample[9 * i + 1], sample[9 * i + 2], sample[9 * i + 3])) - 1) < 1e-5);
            bad += !(sample[9 * i + 4] >= 0 && sample[9 * i + 5] <= 1.00001);
          }
          EXPECT_EQ(bad, 0u) << key.key << " = " << end << ", colour " << color << ", roughness " << roughness;
        }
}

}  // namespace
}  // namespace wale
