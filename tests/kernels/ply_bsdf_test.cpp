// The ply BSDF: against the double oracle, energies, normalisation of its lobes.
#include <gtest/gtest.h>

#include "host/materials.h"
#include "tests/kernels/appearance_oracle.h"
#include "tests/kernels/ply_kernels.h"
#include "tests/kernels/statistics.h"
#include "tests/tolerances.h"

namespace wale {
namespace {
using namespace test;

WPlyMaterial preset(const std::string& name) {
  PlyAppearance a;
  a.preset = name;
  return ply_material(a);
}

class PlyBsdf : public ::testing::TestWithParam<bool> {
 protected:
  void SetUp() override {
    if (GetParam() && !Device::open().traits().fp64) GTEST_SKIP() << "the device has no fp64";
  }
};
INSTANTIATE_TEST_SUITE_P(Precision, PlyBsdf, ::testing::Bool(),
                         [](const auto& i) { return i.param ? "Double" : "Float"; });

// Any axis, any normal on the viewer's side, any outgoing direction.
std::vector<float> random_views(size_t count, bool with_out, uint32_t seed) {
  Random random(seed);
  std::vector<float> out;
  for (size_t i = 0; i < count; ++i) {
    const dvec3 t = random.direction(), wv = random.direction();
    dvec3 n = random.direction();
    n = glm::normalize(n - glm::dot(n, t) * t);
    append(&out, t);
    append(&out, glm::dot(n, wv) < 0 ? -n : n);
    append(&out, wv);
    if (with_out) append(&out, random.direction());
  }
  return out;
}

TEST_P(PlyBsdf, AgreesWithOracle) {
  const double bound = GetParam() ? tolerance::kBsdfDouble : tolerance::kBsdfFloat;
  const KernelRunner runner(kPlyKernels, GetParam());
  constexpr size_t kCount = 4096;
  const std::vector<float> in = random_views(kCount, true, 11);
  for (const std::string& name : ply_presets()) {
    const WPlyMaterial material = preset(name);
    const auto m = runner.upload<WPlyMaterial>({material});
    const auto pdfs = runner.run("densities", kCount, 3, m, runner.upload(in));
    std::vector<float> views;
    for (size_t i = 0; i < kCount; ++i) views.insert(views.end(), &in[12 * i], &in[12 * i] + 9);
    const auto energies = runner.run("energies", kCount, 15, m, runner.upload(views));
    const auto together = runner.run("evaluate", kCount, 4, m, runner.upload(in));
    double worst_pdf = 0, worst_energy = 0, worst_sum = 0;
    for (size_t i = 0; i < kCount; ++i) {
      const float* p = &in[12 * i];
      const PlyOracle oracle(material, unit(p), unit(p + 3), unit(p + 6));
      for (int k = 0; k < 4; ++k) {
        double sum = 0;
        for (int lobe = 0; lobe < 3; ++lobe)
          sum += (k < 3 ? oracle.energy[lobe][k] : energies[15 * i + 9 + lobe]) * oracle.pdf(lobe, unit(p + 9));
        worst_sum = std::max(worst_sum, std::abs(together[4 * i + k] - sum) / (sum + 1e-3));
      }
      for (int lobe = 0; lobe < 3; ++lobe) {
        // Far tails are compared against a floor: they are exponentials of large numbers.
        const double exact = oracle.pdf(lobe, unit(p + 9));
        worst_pdf = std::max(worst_pdf, std::abs(pdfs[3 * i + lobe] - exact) / (exact + 1e-3));
        for (int k = 0; k < 3; ++k)
          worst_energy = std::max(worst_energy, std::abs(energies[15 * i + 3 * lobe + k] - oracle.energy[lobe][k]));
      }
    }
    EXPECT_LT(worst_pdf, bound) << name;
    EXPECT_LT(worst_sum, 2 * bound) << name;  // a product of two rounded numbers
    EXPECT_LT(worst_energy, GetParam() ? tolerance::kEnergyDouble : tolerance::kFurnace) << name;
    RecordProperty("worst_pdf_" + name, std::to_string(worst_pdf));
  }
}

TEST_P(PlyBsdf, WhiteFibresLoseNothing) {
  const KernelRunner runner(kPlyKernels, GetParam());
  constexpr size_t kCount = 4096;
  const auto views = runner.upload(random_views(kCount, false, 5));
  Random random(6);
  for (int trial = 0; trial < 24; ++trial) {
    PlyAppearance a;
    a.preset = ply_presets()[trial % ply_presets().size()];
    a.color = Rgb{1, 1, 1};
    a.ior = random.uniform(1, 3);
    a.roughness = random.uniform(0.001, 1);
    a.fibre_twist = random.uniform(-1.4, 1.4);
    const auto out = runner.run("energies", kCount, 15, runner.upload<WPlyMaterial>({ply_material(a)}), views);
    double worst = 0, worst_q = 0;
    for (size_t i = 0; i < kCount; ++i)
      for (int k = 0; k < 3; ++k) {
        const double* o = &out[15 * i];
        worst = std::max(worst, std::abs(o[k] + o[3 + k] + o[6 + k] - 1));
        worst_q = std::max(worst_q, std::abs(o[9] + o[10] + o[11] - 1));
      }
    EXPECT_LE(worst, tolerance::kFurnace) << a.preset;
    EXPECT_LE(worst_q, tolerance::kFurnace) << a.preset;
  }
}

// Detail moves energy between the lobes and takes none; so do the papers' lobes without their shadow.
TEST_P(PlyBsdf, WhiteFibresLoseNothingToDetail) {
  const std::vector<float> views = random_views(20000, false, 13);
  for (const char* variant : {"-DW_TEST_DETAIL", "-DW_PAPER_LOBES"}) {
    const KernelRunner runner(kPlyKernels, GetParam(), variant);
    PlyAppearance a;
    a.preset = "cotton";
    a.color = Rgb{1, 1, 1};
    const auto out = runner.run("energies", views.size() / 9, 15, runner.upload<WPlyMaterial>({ply_material(a)}),
                                runner.upload(views));
    double worst = 0;
    for (size_t i = 0; i < out.size(); i += 15)
      for (int k = 0; k < 3; ++k) worst = std::max(worst, std::abs(out[i + k] + out[i + 3 + k] + out[i + 6 + k] - 1));
    EXPECT_LT(worst, tolerance::kFurnace) << variant;
  }
}

// The papers take the shadow as a plain factor: energy is lost, and only where there is shadow.
TEST_P(PlyBsdf, PaperShadowLosesEnergy) {
  const KernelRunner runner(kPlyKernels, GetParam(), "-DW_PAPER_LOBES -DW_TEST_DETAIL");
  PlyAppearance a;
  a.color = Rgb{1, 1, 1};
  const auto out = runner.run("energies", 1, 15, runner.upload<WPlyMaterial>({ply_material(a)}),
                              runner.upload(floats(ply_view(0.2, 0.1))));
  const double surface = out[0], body = out[3] + out[6];
  EXPECT_NEAR(body, (1 - surface) * (1 - 0.7 * (1 - 0.2)), 1e-5);
}

// Light that turns back has gone through more fibres: hits_back darkens lobe B alone, and white stays white.
TEST_P(PlyBsdf, LightThatTurnsBackIsDarker) {
  const KernelRunner runner(kPlyKernels, GetParam());
  const auto view = runner.upload(floats(ply_view(0.3, 0.2)));
  WPlyMaterial m = preset("wool");
  const auto energies = [&](float color, float hits_back) {
    m.fibre = {color, color, color, 0};
    m.hits_back = hits_back;
    return runner.run("energies", 1, 15, runner.upload<WPlyMaterial>({m}), view);
  };
  const auto even = energies(0.8f, 1), more = energies(0.8f, 1.5f);
  EXPECT_EQ(even[3], more[3]);
  EXPECT_LT(more[6], 0.85 * even[6]);
  EXPECT_NEAR(energies(1, 1)[6], energies(1, 3)[6], 1e-6);
}

TEST_P(PlyBsdf, DarkFibresAbsorb) {
  const KernelRunner runner(kPlyKernels, GetParam());
  PlyAppearance a;
  a.forward = a.back = Rgb{0, 0, 0};
  const auto view = runner.upload(floats(ply_view(0.3, 0.2)));
  const auto out = runner.run("energies", 1, 15, runner.upload<WPlyMaterial>({ply_material(a)}), view);
  EXPECT_GT(out[0], 0.005);  // the surface still shines
  EXPECT_LT(out[0], 0.05);
  EXPECT_EQ(out[3] + out[6], 0);
  EXPECT_EQ(out[9], 1);
}

TEST_P(PlyBsdf, LobesIntegrateToOne) {
  const KernelRunner runner(kPlyKernels, GetParam());
  const cl_uint n = 384;
  for (const char* name : {GetParam() ? "cotton" : "silk"}) {
    const auto m = runner.upload<WPlyMaterial>({preset(name)});
    for (const double h : {0.0, 0.5, -0.95})
      for (const double degrees : {0.0, 45.0, 80.0}) {
        const auto view = runner.upload(floats(ply_view(h, degrees * M_PI / 180)));
        for (cl_int lobe = 0; lobe < 3; ++lobe) {
          double sum = 0;
          for (const double p : runner.run("density_angles", size_t(n) * n, 1, m, view, lobe, n)) sum += p;
          EXPECT_NEAR(sum * 2 * M_PI * M_PI / (double(n) * n), 1, tolerance::kPdfIntegral)
              << name << " lobe " << lobe << " h " << h << " theta " << degrees;
        }
      }
  }
}

TEST(PlyTransmittance, IsTheShareOfLightThatMeetsNoFibre) {
  const KernelRunner runner(R"(
#include "appearance/ply_bsdf.clh"
__kernel void pass(__global const float* c, __global w_real* out, uint count) {
  const uint i = get_global_id(0);
  if (i < count) out[i] = w_ply_transmittance(2.5f, c[i]);
})",
                            false);
  const auto out = runner.run("pass", 3, 1, runner.upload<float>({0, 0.5f, 1}));
  EXPECT_EQ(out[0], 1);
  EXPECT_NEAR(out[1], std::exp(-2.5), 1e-7);
  EXPECT_NEAR(out[2], std::exp(-5.0), 1e-8);
}

}  // namespace
}  // namespace wale
