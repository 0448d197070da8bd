// Light tables: running sums, choice by power, refusal of bad input.
#include "host/light_tables.h"

#include <gtest/gtest.h>

#include <limits>

#include "geom/error.h"

namespace wale {
namespace {

TEST(LightTables, ChoicesAddUpAndBlackIsNeverChosen) {
  LightTableBuilder builder;
  builder.add_sphere({1, 1, 1}, {0, 0, 0}, 1);
  builder.add_sphere({0, 0, 0}, {0, 0, 0}, 1);
  builder.add_sphere({1e-6f, 0, 0}, {0, 0, 0}, 1);
  builder.add_environment({1, 1, 1}, 2);
  const LightTables tables = builder.finish();
  double sum = 0;
  for (const WLight& light : tables.lights) sum += light.radiance.w;
  EXPECT_NEAR(sum, 1, 1e-6);
  EXPECT_EQ(tables.lights[1].radiance.w, 0);
  EXPECT_GT(tables.lights[2].radiance.w, 0.03);
  EXPECT_GT(tables.lights[3].radiance.w, tables.lights[0].radiance.w);
}

TEST(LightTables, UniformChoiceForgetsPowerButNotBlackness) {
  LightTableBuilder builder;
  builder.add_sphere({9, 9, 9}, {0, 0, 0}, 1);
  builder.add_sphere({0, 0, 0}, {0, 0, 0}, 1);
  builder.add_sphere({1e-6f, 0, 0}, {0, 0, 0}, 1);
  const LightTables tables = builder.finish(LightChoice::uniform);
  EXPECT_EQ(tables.lights[0].radiance.w, 0.5f);
  EXPECT_EQ(tables.lights[1].radiance.w, 0);
  EXPECT_EQ(tables.lights[2].radiance.w, 0.5f);
  std::vector<float> sky(8 * 4 * 3, 0.01f);
  sky[3 * (8 * 1 + 2)] = 500;
  const EnvironmentTables even = environment_tables(sky, 8, 4, LightChoice::uniform);
  for (const w_float4& texel : even.texels) EXPECT_EQ(texel.w, 1);
  EXPECT_NEAR(even.average, 1, 1e-6);
}

TEST(LightTables, MeshesKeepTheirRangesAndAreas) {
  const LightTriangle one = {0, 0, 0, 1, 0, 0, 0, 1, 0}, none = {0, 0, 0, 0, 0, 0, 0, 0, 0};
  LightTableBuilder builder;
  builder.add_mesh({1, 1, 1}, {one}, {7}, false);
  builder.add_mesh({1, 1, 1}, {one, one, one, none}, {3, 4, 5, 6}, true);
  const LightTables t = builder.finish();
  EXPECT_EQ(t.lights[1].first_triangle, 1u);
  EXPECT_EQ(t.lights[1].triangles, 4u);
  EXPECT_FLOAT_EQ(t.lights[1].area, 1.5f);
  EXPECT_EQ(t.triangle_index, (std::vector<int32_t>{7, 3, 4, 5, 6}));
  EXPECT_EQ(t.cdf.size(), 5u);
  EXPECT_FLOAT_EQ(t.cdf[1], 1 / 3.0f);
  EXPECT_EQ(t.cdf[3], 1);  // the last triangle with an area ends the sum: the empty one has no share
  EXPECT_EQ(t.lights[0].center.w, 0);
  EXPECT_EQ(t.lights[1].center.w, 1);
}

TEST(LightTables, RefusesWhatCannotShine) {
  LightTableBuilder builder;
  EXPECT_THROW(builder.add_sphere({-1, 0, 0}, {0, 0, 0}, 1), Error);
  EXPECT_THROW(builder.add_sphere({1, 1, 1}, {0, 0, 0}, 0), Error);
  EXPECT_THROW(builder.add_mesh({1, 1, 1}, {LightTriangle{}}, {0}, false), Error);
  EXPECT_THROW(environment_tables({1, 1, std::numeric_limits<float>::quiet_NaN()}, 1, 1), Error);
  EXPECT_THROW(environment_tables({1, -1, 1}, 1, 1), Error);
  EXPECT_THROW(environment_tables({1, 1}, 1, 1), Error);
}

TEST(LightTables, UniformImageHasItsValueAsMeanWeight) {
  const EnvironmentTables t = environment_tables(std::vector<float>(6 * 4 * 3, 2.0f), 6, 4);
  EXPECT_FLOAT_EQ(t.average, 2);
  EXPECT_EQ(t.cdf.size(), size_t(4 + 24));
  EXPECT_EQ(t.cdf[3], 1);
  EXPECT_FLOAT_EQ(t.cdf[1], 0.5f);  // half of the sphere is above the horizon
  EXPECT_FLOAT_EQ(t.cdf[4 + 2], 0.5f);
}

}  // namespace
}  // namespace wale
