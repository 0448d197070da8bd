// Hits side by side in the lanes of vectors are shaded as each would be alone, to the last bit.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "host/materials.h"
#include "tests/kernels/ply_kernels.h"
#include "tests/kernels/statistics.h"

namespace wale {
namespace {
using namespace test;

// Hit i: t, n, wv, a direction and its fibre, 17 floats; of materials[i % material_count]. Out: lobe, number left,
// drawn direction, its density and rgb, density and rgb of the given direction, derivative by roughness.
const std::string kHits = std::string("#define W_GRADIENTS\n") + kPlyKernels + R"(
#include "appearance/ply_gradient.clh"
static inline void set_unit(w_v3* to, uint i, __global const float* p) {
  w_v3_set_lane(to, i, normalize((w_real3)(p[0], p[1], p[2])));
}
__kernel void hits(__global const WPlyMaterial* materials, uint material_count, __global const float* in,
                   __global const float* numbers, __global w_real* out, uint count) {
  const uint first = get_global_id(0) * W_LANES;
  if (first >= count) return;
  WPlyMaterialLanes material;
  WFibreLanes fibre;
  w_v3 t, n, wv, w;
  w_vf u0, u1, u2, u3;
  for (uint i = 0; i < W_LANES; ++i) {
    const uint hit = min(first + i, count - 1u);
    __global const float *p = in + 17 * hit, *u = numbers + 4 * hit;
    w_ply_material_set_lane(&material, i, materials[hit % material_count]);
    set_unit(&t, i, p);
    set_unit(&n, i, p + 3);
    set_unit(&wv, i, p + 6);
    set_unit(&w, i, p + 9);
    const WFibreAt at = {p[12], p[13], p[14], p[15], p[16]};
    w_fibre_set_lane(&fibre, i, at);
    w_lane_of(u0, i) = u[0];
    w_lane_of(u1, i) = u[1];
    w_lane_of(u2, i) = u[2];
    w_lane_of(u3, i) = u[3];
  }
  const WPlyShade s = w_ply_setup_detail(&material, t, n, wv, fibre);
  const WPlyShade tilted = w_ply_setup_tilted(&material, t, n, wv, fibre);
  w_vf left, drawn_density, density;
  const w_vi lobe = w_ply_choose(&s, u0, &left);
  const w_v3 drawn = w_ply_sample(&s, lobe, u1, u2, u3), drawn_f = w_ply_eval(&s, drawn, &drawn_density);
  const w_v3 f = w_ply_eval(&s, w, &density);
  const WPlyGradient g = w_ply_gradient(&s, &tilted, material.beta_r, w, f);
  for (uint i = 0; i < min((uint)W_LANES, count - first); ++i) {
    __global w_real* o = out + 14 * (first + i);
    o[0] = w_lane_of_int(lobe, i);
    o[1] = w_lane_of(left, i);
    vstore3(w_v3_lane(&drawn, i), 0, o + 2);
    o[5] = w_lane_of(drawn_density, i);
    vstore3(w_v3_lane(&drawn_f, i), 0, o + 6);
    o[9] = w_lane_of(density, i);
    vstore3(w_v3_lane(&f, i), 0, o + 10);
    o[13] = w_lane_of(g.d[W_GRADIENT_ROUGHNESS].x, i);
  }
})";

std::vector<double> shade(const std::vector<WPlyMaterial>& materials, const std::vector<float>& in,
                          const std::vector<float>& numbers, int lanes, const std::string& variant) {
  const KernelRunner runner(fmt::format("#undef W_LANES\n#define W_LANES {}\n", lanes) + kHits, false, variant);
  return runner.run("hits", numbers.size() / 4, 14, runner.upload(materials), uint32_t(materials.size()),
                    runner.upload(in), runner.upload(numbers));
}

TEST(PlyLanes, HitsSideBySideAreShadedAsEachAlone) {
  constexpr size_t kHitCount = 10007;  // not a multiple of any width
  std::vector<WPlyMaterial> materials;
  for (const std::string& name : ply_presets()) {
    PlyAppearance a;
    a.preset = name;
    materials.push_back(ply_material(a));
  }
  Random random(5);
  std::vector<float> in, numbers;
  for (size_t i = 0; i < kHitCount; ++i) {
    const dvec3 t = random.direction(), wv = i % 97 == 0 ? t : random.direction();  // some along the axis
    append(&in, t);
    append(&in, i % 89 == 0 ? t : random.direction());  // some at caps
    append(&in, wv);
    append(&in, i % 83 == 0 ? wv : random.direction());
    for (const double x : {2 * random.uniform() - 1, random.uniform() - 0.5, 2 * random.uniform(), random.uniform(),
                           0.02 * random.uniform()})
      in.push_back(float(x));
    for (int k = 0; k < 4; ++k) numbers.push_back(float(0.9999999 * random.uniform()));
  }
  for (const std::string variant : {"", "-DW_PORTABLE", "-DW_PAPER_LOBES"}) {
    const std::vector<double> alone = shade(materials, in, numbers, 1, variant);
    size_t bright = 0;
    for (const double x : alone) {
      ASSERT_TRUE(std::isfinite(x));
      bright += x > 1e-3;
    }
    EXPECT_GT(bright, alone.size() / 3);  // it is shaded
    for (const int lanes : {8, 16}) {
      const std::vector<double> together = shade(materials, in, numbers, lanes, variant);
      size_t differ = 0;
      for (size_t i = 0; i < alone.size(); ++i) differ += alone[i] != together[i];
      EXPECT_EQ(differ, 0u) << lanes << " lanes " << variant << ", of " << alone.size();
    }
  }
}

}  // namespace
}  // namespace wale
