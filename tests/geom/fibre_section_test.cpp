#include "geom/fibre_section.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace wale {
namespace {

TEST(FibreSection, DenseBundlesDoNotOverlap) {
  for (const auto& [fibres, packing] : {std::pair{75, 0.5}, {120, 0.5}, {37, 0.3}, {300, 0.2}, {60, 0.65}}) {
    const FibreSection s = make_fibre_section({.fibres = fibres, .packing = packing});
    ASSERT_EQ(int(s.fibres.size()), fibres);
    EXPECT_NEAR(s.fibre_radius * s.fibre_radius * fibres, packing, 1e-12);
    EXPECT_LE(s.overlap, 2e-3) << fibres << " fibres, packing " << packing;
    for (const auto& f : s.fibres) EXPECT_LE(f.distance, 1 - s.fibre_radius + 1e-12);
  }
}

TEST(FibreSection, UniformDensityFillsTheSectionEvenly) {
  // Half of the area that centres may take lies within 1/sqrt(2) of its radius.
  double inner = 0, all = 0;
  for (uint32_t seed = 1; seed <= 40; ++seed) {
    const FibreSection s = make_fibre_section({.fibres = 60, .packing = 0.1, .seed = seed});
    for (const auto& f : s.fibres) {
      inner += f.distance < (1 - s.fibre_radius) / std::sqrt(2.0);
      all += 1;
    }
  }
  EXPECT_NEAR(inner / all, 0.5, 4 * 0.5 / std::sqrt(all));
}

TEST(FibreSection, RadialDensityDrawsFibresInwards) {
  double uniform = 0, dense = 0;
  for (uint32_t seed = 1; seed <= 20; ++seed) {
    for (const auto& f : make_fibre_section({.fibres = 60, .packing = 0.1, .seed = seed}).fibres) uniform += f.distance;
    for (const auto& f :
         make_fibre_section({.fibres = 60, .packing = 0.1, .radial_beta = 0.682, .radial_epsilon = 0.139, .seed = seed})
             .fibres)
      dense += f.distance;
  }
  EXPECT_LT(dense, 0.95 * uniform);
}

TEST(FibreSection, MigrationStaysBetweenItsBounds) {
  const FibreRecipe recipe{.migration_min = 0.7, .migration_rate = 1.9};
  const FibreSection::Fibre fibre{0.8, 0.3, 1.1};
  double least = 1, most = 0;
  for (double theta = 0; theta < 40; theta += 0.01) {
    least = std::min(least, fibre_distance(fibre, recipe, theta));
    most = std::max(most, fibre_distance(fibre, recipe, theta));
  }
  EXPECT_NEAR(least, 0.56, 1e-4);
  EXPECT_NEAR(most, 0.8, 1e-4);
}

TEST(FibreSection, SameSeedSameSection) {
  const FibreSection a = make_fibre_section({.seed = 7}), b = make_fibre_section({.seed = 7});
  for (size_t i = 0; i < a.fibres.size(); ++i) EXPECT_EQ(a.fibres[i].angle, b.fibres[i].angle);
  EXPECT_NE(a.fibres[0].angle, make_fibre_section({.seed = 8}).fibres[0].angle);
}

TEST(FibreSection, RefusesWhatCannotBe) {
  EXPECT_ANY_THROW(make_fibre_section({.fibres = 0}));
  EXPECT_ANY_THROW(make_fibre_section({.packing = 0.9}));
  EXPECT_ANY_THROW(make_fibre_section({.radial_epsilon = 0.7}));
  EXPECT_ANY_THROW(make_fibre_section({.migration_min = 0}));
  EXPECT_ANY_THROW(make_fibre_section({.fibres = 2, .packing = 0.7}));  // two discs of that area do not fit
}

}  // namespace
}  // namespace wale
