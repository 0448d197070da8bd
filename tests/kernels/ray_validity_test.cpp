// Rays that are no rays: NaN, infinities, directions of no length. They miss, are counted, cost no more than good ones,
// and leave their neighbours in the batch alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "tests/kernels/synthetic.h"

namespace wale::test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();
constexpr double kMostTime = 2.5;  // of the time of good rays

/// One good ray, spoilt in every way: each component NaN, +Inf, -Inf, a signalling NaN; tmax NaN; directions of no,
/// denormal, tiny or huge length.
std::vector<Ray> spoilt(const Ray& good) {
  std::vector<Ray> bad;
  const float values[] = {kNan, -kNan, kInf, -kInf, std::bit_cast<float>(0x7f800001u)};
  for (const float value : values)
    for (int k = 0; k < 3; ++k)
      for (float(Ray::*part)[3] : {&Ray::o, &Ray::l, &Ray::d}) {
        bad.push_back(good);
        (bad.back().*part)[k] = value;
      }
  for (const float value : {kNan, -kNan, std::bit_cast<float>(0x7f800001u)}) {
    bad.push_back(good);
    bad.back().tmax = value;
  }
  for (const float length : {0.0f, -0.0f, 1e-45f, 1e-40f, 1e-20f, 0.1f, 10.0f, 1e20f, 3e38f}) {
    bad.push_back(good);
    for (int k = 0; k < 3; ++k) bad.back().d[k] = k == 1 ? length : 0.0f;
  }
  return bad;
}

struct Cloth {
  Strands strands = stockinette(12, 14, 40);
  Tracer tracer{test_device(), strands};
  std::vector<Ray> good = primary_rays(tracer.tree().bounds, 30000, 3);
};

const std::string& lanes() {
  static const std::string options = "-DW_LANES=" + std::to_string(test_device().traits().lanes);
  return options;
}

TEST(RayValidity, BadRaysMissAndAreCounted) {
  Cloth cloth;
  const std::vector<Ray> bad = spoilt(cloth.good[0]);
  for (const char* options : {"-DW_LANES=1", "-DW_LANES=16", "-DW_LANES=16 -DW_PORTABLE", "-DW_LANES=1 -DW_SIMT"}) {
    const uint32_t before = cloth.tracer.events()[W_EVENT_RAY];
    const std::vector<Hit> hits = cloth.tracer.trace(bad, options);
    for (size_t i = 0; i < bad.size(); ++i) {
      EXPECT_EQ(hits[i].kind, uint32_t(W_HIT_NONE)) << i << " " << options;
      EXPECT_EQ(hits[i].occluded, 0u) << i << " " << options;
      EXPECT_EQ(hits[i].t, 1e30f) << i << " " << options;
    }
    // Nearest hit and occlusion of each.
    EXPECT_EQ(cloth.tracer.events()[W_EVENT_RAY] - before, 2 * bad.size()) << options;
  }
  if (!test_device().traits().fp64) GTEST_SKIP() << "the double build needs cl_khr_fp64";
  const uint32_t before = cloth.tracer.events()[W_EVENT_RAY];
  for (const HitOf<double>& hit : cloth.tracer.trace_in_double(bad)) EXPECT_EQ(hit.kind, uint32_t(W_HIT_NONE));
  EXPECT_EQ(cloth.tracer.events()[W_EVENT_RAY] - before, 2 * bad.size());
}

// An infinite tmax is a ray that ends nowhere, a negative one a ray that ends before it starts: both are good rays.
TEST(RayValidity, EndsMayLieAnywhere) {
  Cloth cloth;
  std::vector<Ray> endless(cloth.good.begin(), cloth.good.begin() + 2000), ended = endless;
  for (Ray& ray : endless) ray.tmax = kInf;
  for (size_t i = 0; i < ended.size(); ++i) ended[i].tmax = i % 2 ? -kInf : -1.0f;
  const std::vector<Hit> plain = cloth.tracer.trace({cloth.good.begin(), cloth.good.begin() + 2000}, lanes());
  const std::vector<Hit> hits = cloth.tracer.trace(endless, lanes());
  for (size_t i = 0; i < hits.size(); ++i) {
    EXPECT_EQ(hits[i].t, plain[i].t);
    EXPECT_EQ(hits[i].code, plain[i].code);
  }
  for (const Hit& hit : cloth.tracer.trace(ended, lanes())) EXPECT_EQ(hit.kind, uint32_t(W_HIT_NONE));
  EXPECT_EQ(cloth.tracer.events()[W_EVENT_RAY], 0u);
}

TEST(RayValidity, BadRaysLeaveTheirNeighboursAlone) {
  Cloth cloth;
  const std::vector<Hit> alone = cloth.tracer.trace(cloth.good, lanes());
  const std::vector<Ray> bad = spoilt(cloth.good[0]);
  std::vector<Ray> mixed;
  for (size_t i = 0; i < cloth.good.size(); ++i) {
    mixed.push_back(cloth.good[i]);
    mixed.push_back(bad[i % bad.size()]);
  }
  const std::vector<Hit> hits = cloth.tracer.trace(mixed, lanes());
  size_t met = 0;
  for (size_t i = 0; i < alone.size(); ++i) {
    EXPECT_EQ(std::memcmp(&hits[2 * i], &alone[i], sizeof(Hit)), 0) << i;
    EXPECT_EQ(hits[2 * i + 1].kind, uint32_t(W_HIT_NONE)) << i;
    met += alone[i].kind == W_HIT_PLY;
  }
  EXPECT_GT(met, alone.size() / 10);
  EXPECT_EQ(cloth.tracer.events()[W_EVENT_RAY], 2 * alone.size());
}

TEST(RayValidity, BadRaysCostNoMoreThanGoodOnes) {
  Cloth cloth;
  const std::vector<Ray> kinds = spoilt(cloth.good[0]);
  std::vector<Ray> bad;
  for (size_t i = 0; i < cloth.good.size(); ++i) bad.push_back(kinds[i % kinds.size()]);
  for (const char* kernel : {"closest", "occluded"}) {
    double good_time = 1e30, bad_time = 1e30;
    for (int round = 0; round < 5; ++round) {
      good_time = std::min(good_time, cloth.tracer.time(cloth.good, lanes(), kernel));
      bad_time = std::min(bad_time, cloth.tracer.time(bad, lanes(), kernel));
    }
    EXPECT_LT(bad_time, kMostTime * good_time) << kernel;
  }
}

// Any 32 bits as rays: finite ones far outside what a scene can hold, denormals, zeros. An answer comes, and it is no
// NaN.
TEST(RayValidity, RandomBitsHaveABoundedAnswer) {
  Cloth cloth;
  std::mt19937 random(31);
  std::vector<Ray> rays;
  for (size_t i = 0; i < cloth.good.size(); ++i) {
    Ray ray = cloth.good[i];
    for (int k = 0; k < 3; ++k) {
      const float any = std::bit_cast<float>(uint32_t(random()));
      (i % 3 == 0 ? ray.o : ray.l)[k] = any;
      if (i % 4 == 0) ray.d[k] = std::bit_cast<float>(uint32_t(random()));
    }
    rays.push_back(ray);
  }
  for (const Hit& hit : cloth.tracer.trace(rays, lanes())) EXPECT_FALSE(std::isnan(hit.t));
  double good_time = 1e30, any_time = 1e30;
  for (int round = 0; round < 3; ++round) {
    good_time = std::min(good_time, cloth.tracer.time(cloth.good, lanes(), "closest"));
    any_time = std::min(any_time, cloth.tracer.time(rays, lanes(), "closest"));
  }
  EXPECT_LT(any_time, kMostTime * good_time);
}

}  // namespace
}  // namespace wale::test
