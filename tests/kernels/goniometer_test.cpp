// Virtual goniometer: it loses no light, samples what its densities say, and meets fibres where they are.
#include <gtest/gtest.h>

#include <cmath>

#include "bench/goniometer/measure.h"
#include "bench/goniometer/published.h"
#include "tests/kernels/appearance_oracle.h"
#include "tests/kernels/statistics.h"

namespace wale {
namespace {

constexpr double kDegree = M_PI / 180;

/// Samples' sines of inclination and azimuths from w_i, for one lobe.
struct Lobe {
  std::vector<double> sin_o, phi;
};
std::pair<Lobe, Lobe> sample(const FibreScattering& fibre, double theta, int n) {
  const dvec3 axis = glm::normalize(dvec3(0.3, -0.5, 0.8)), x = glm::normalize(glm::cross(axis, dvec3(1, 0, 0)));
  const dvec3 y = glm::cross(axis, x), w_i = std::sin(theta) * axis + std::cos(theta) * x;
  std::pair<Lobe, Lobe> out;
  for (int i = 0; i < n; ++i) {
    PathRandom random(11, uint64_t(i));
    const FibreEvent e = scatter(fibre, axis, w_i, random);
    Lobe& lobe = e.reflected ? out.first : out.second;
    lobe.sin_o.push_back(glm::dot(e.direction, axis));
    lobe.phi.push_back(std::atan2(glm::dot(e.direction, y), glm::dot(e.direction, x)));
  }
  return out;
}

/// p-value of samples in [low, high] against a density.
template <typename Density>
double p_value(const std::vector<double>& samples, double low, double high, Density density) {
  constexpr int kCells = 60, kSteps = 20;
  std::vector<double> counts(kCells), expected(kCells);
  for (const double s : samples) ++counts[size_t(std::clamp(int((s - low) / (high - low) * kCells), 0, kCells - 1))];
  for (int i = 0; i < kCells; ++i)
    for (int j = 0; j < kSteps; ++j)
      expected[size_t(i)] += density(low + (high - low) * (i + (j + 0.5) / kSteps) / kCells) * (high - low) /
                             (kCells * kSteps) * double(samples.size());
  return test::chi_squared_p(counts, expected);
}

TEST(Goniometer, FibresScatterByTheirDensities) {
  constexpr double kLeast = 1e-5;  // 24 tests
  for (const Longitudinal kind : {Longitudinal::gaussian, Longitudinal::d_eon}) {
    for (const double theta : {0.0, 40 * kDegree, -75 * kDegree}) {
      const FibreScattering fibre{dvec3(.4), dvec3(1), 8 * kDegree, 25 * kDegree, 38 * kDegree, kind};
      const auto [r, tt] = sample(fibre, theta, 100000);
      EXPECT_NEAR(double(r.sin_o.size()), 1e5 * fibre_fresnel(fibre, std::cos(theta)).x, 700);
      for (const auto& [lobe, beta] : {std::pair{&r, fibre.beta_r}, {&tt, fibre.beta_tt}}) {
        // Over theta, where narrow lobes are smooth: d(sin) = cos d(theta).
        std::vector<double> angles;
        for (const double s : lobe->sin_o) angles.push_back(std::asin(s));
        const auto density = [&](double angle) {
          return std::cos(angle) * longitudinal_density(kind, std::sin(theta), std::sin(angle), beta);
        };
        EXPECT_GT(p_value(angles, -M_PI / 2, M_PI / 2, density), kLeast) << int(kind) << " " << theta << " " << beta;
      }
      EXPECT_GT(p_value(r.phi, -M_PI, M_PI, [](double) { return 1 / (2 * M_PI); }), kLeast) << theta;
      EXPECT_GT(p_value(tt.phi, -M_PI, M_PI, [&](double x) { return transmit_azimuth_density(x, fibre.gamma_tt); }),
                kLeast)
          << theta;
    }
  }
}

TEST(Goniometer, TheLongitudinalFunctionIsTheRenderers) {
  for (const double beta : {3 * kDegree, 12 * kDegree, 60 * kDegree})
    for (double i = -1.4; i < 1.5; i += 0.35)
      for (double o = -1.5; o < 1.5; o += 0.2) {
        const double theirs = test::oracle_longitudinal(i, o, beta * beta);
        EXPECT_NEAR(longitudinal_density(Longitudinal::d_eon, std::sin(i), std::sin(o), beta), theirs,
                    1e-7 * theirs + 1e-12);
      }
}

TEST(Goniometer, WhiteBundlesLoseNothing) {
  for (PublishedBundle bundle : published_bundles()) {
    bundle.fibre.transmit = dvec3(1);
    const Measurement colored = measure(bundle.recipe, bundle.fibre, Incidence{.theta = 0.5, .paths = 4000});
    EXPECT_NEAR(colored.total.mean, 1, 4 * colored.total.error + 1e-9) << bundle.name;
    // A grey surface: every path then carries exactly what it started with.
    bundle.fibre.reflect = dvec3(bundle.fibre.reflect.x);
    const Measurement grey = measure(bundle.recipe, bundle.fibre, Incidence{.theta = -0.9, .paths = 4000});
    EXPECT_NEAR(grey.total.mean, 1, 1e-9) << bundle.name;
    double parts = grey.uncollided.mean;
    for (size_t k = 0; k < 3; ++k) parts += (grey.surface[k].mean + grey.body[k].mean) / 3;
    EXPECT_NEAR(parts, 1, 1e-9) << bundle.name;
  }
}

TEST(Goniometer, ThreadsDoNotMatter) {
  const FibreRecipe recipe{.fibres = 40, .packing = 0.3, .twist = 0.3};
  const Measurement one = measure(recipe, {}, Incidence{.paths = 9000}, 1);
  const Measurement many = measure(recipe, {}, Incidence{.paths = 9000}, 7);
  EXPECT_EQ(one.body[0].mean, many.body[0].mean);
  EXPECT_EQ(one.theta_sd, many.theta_sd);
  EXPECT_EQ(one.phi, many.phi);
}

/// Whether a straight line misses every fibre of the endless helical bundle: points along it against the tangent line
/// of each helix at their height. No slabs, no grid.
bool passes(const FibreSection& section, double twist, dvec3 origin, dvec3 direction) {
  constexpr int kSteps = 800;
  const double length =
      -2 * (origin.x * direction.x + origin.y * direction.y) / (direction.x * direction.x + direction.y * direction.y);
  for (int i = 0; i < kSteps; ++i) {
    const dvec3 p = origin + (i + 0.5) / kSteps * length * direction;
    for (const auto& f : section.fibres) {
      const double angle = f.angle + twist * p.z;
      const dvec3 radial(std::cos(angle), std::sin(angle), 0), tangent(-std::sin(angle), std::cos(angle), 0);
      const dvec3 axis = glm::normalize(dvec3(0, 0, 1) + twist * f.distance * tangent);
      const dvec3 away = dvec3(p.x, p.y, 0) - f.distance * radial;
      if (glm::length(glm::cross(away, axis)) < section.fibre_radius) return false;
    }
  }
  return true;
}

TEST(Goniometer, LightPassesBetweenHelicalFibres) {
  const FibreScattering black{dvec3(0), dvec3(0), .1, .1, .1, Longitudinal::d_eon};
  struct Case {
    double twist, theta, h;
  };
  for (const Case c : {Case{0, 0, .8}, {0, 1, .8}, {.4, 0, .85}, {.4, 1, .85}, {-.4, 1, .85}, {.7, .6, -.7}}) {
    const FibreRecipe recipe{.fibres = 30, .packing = 0.15, .twist = c.twist, .seed = 3};
    const Measurement ours =
        measure(recipe, black, Incidence{.theta = c.theta, .h_low = c.h, .h_high = c.h, .paths = 40000, .sections = 1});
    const FibreSection section = make_fibre_section(recipe);
    test::Random random(5);
    constexpr int kRays = 2500;
    int passed = 0;
    for (int i = 0; i < kRays; ++i) {
      const double spin = random.uniform(0, 2 * M_PI), gamma = std::asin(c.h);
      const dvec3 origin(std::cos(gamma + spin), std::sin(gamma + spin), random.uniform(-5, 5));
      passed += passes(section, c.twist, origin,
                       {-std::cos(c.theta) * std::cos(spin), -std::cos(c.theta) * std::sin(spin), -std::sin(c.theta)});
    }
    const double theirs = double(passed) / kRays, sigma = std::sqrt(theirs * (1 - theirs) / kRays);
    ASSERT_GT(theirs, 0.02);
    EXPECT_NEAR(ours.uncollided.mean, theirs, 4 * sigma) << c.twist << " " << c.theta << " " << c.h;
  }
}

TEST(Goniometer, AgreesWithPublishedBundles) {
  for (const PublishedBundle& p : published_bundles()) {
    if (p.name != "fleece" && p.name != "cotton" && p.name != "Z_silk1" && p.name != "P_wool") continue;
    const Measurement m = measure(p.recipe, p.fibre, Incidence{.paths = 24000, .sections = 48});
    EXPECT_NEAR(m.uncollided.mean, p.t0, .01) << p.name;
    EXPECT_NEAR((m.surface[0].mean + m.surface[1].mean + m.surface[2].mean) / 3, p.r1, .01) << p.name;
    EXPECT_NEAR(m.forward, p.forward, .07) << p.name;
    EXPECT_NEAR(m.theta_sd / kDegree, p.theta_sd, 3) << p.name;
    for (size_t k = 0; k < 3; ++k) {
      const double f = p.fibre.reflect[int(k)], omega = f + (1 - f) * p.fibre.transmit[int(k)];
      EXPECT_NEAR(m.body[k].mean, p.body[k], omega < .6 ? .10 : .05) << p.name << " channel " << k;
    }
  }
}

TEST(Goniometer, DyedFibresFollowFromWhiteOnes) {
  // Directions do not depend on the colour, so one white measurement holds every grey one.
  const FibreRecipe recipe{.fibres = 60, .packing = 0.4, .twist = 0.35};
  FibreScattering fibre{dvec3(.047), dvec3(1), .1, .2, .5, Longitudinal::d_eon};
  const Measurement white = measure(recipe, fibre, Incidence{.paths = 40000});
  fibre.transmit = dvec3(.95, .8, .5);
  const Measurement dyed = measure(recipe, fibre, Incidence{.paths = 40000, .seed = 9});
  for (size_t k = 0; k < 3; ++k) {
    const double expected = white.body[0].mean * body_albedo(white, fibre.transmit[int(k)]);
    EXPECT_NEAR(dyed.body[k].mean, expected, 6 * dyed.body[k].error) << k;
  }
}

}  // namespace
}  // namespace wale
