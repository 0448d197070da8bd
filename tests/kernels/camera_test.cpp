// Camera rays: centre, corners, the plane in focus, the film filters.
#include <gtest/gtest.h>

#include "shared/wale_types.h"
#include "tests/kernels/kernel_runner.h"
#include "tests/kernels/statistics.h"

namespace wale {
namespace {
using namespace test;

const char* kKernels = R"(
#include "camera.clh"
/* pixel x, y, then 4 numbers (6 floats) -> origin, direction */
__kernel void rays(__global const WCamera* camera, __global const float* in, __global w_real* out, uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  __global const float* p = in + 6 * i;
  w_real3 o, d;
  w_camera_ray(*camera, (int)p[0], (int)p[1], (float4)(p[2], p[3], p[4], p[5]), &o, &d);
  vstore3(o, 2 * i, out);
  vstore3(d, 2 * i + 1, out);
}
)";

// Looks along +x from (1, 2, 3), up y: right is +z.
WCamera camera() {
  WCamera c{};
  c.origin = {1, 2, 3, 0};
  c.right = {0, 0, 1, 0};
  c.up = {0, 1, 0, 0};
  c.forward = {1, 0, 0, 0};
  c.half_width = 0.8f;
  c.half_height = 0.6f;
  c.width = 8;
  c.height = 6;
  c.focus = 4;
  return c;
}

struct Ray {
  dvec3 origin, direction;
};

std::vector<Ray> rays(const WCamera& c, const std::vector<float>& in) {
  const KernelRunner runner(kKernels, false);
  const auto out = runner.run("rays", in.size() / 6, 6, runner.upload<WCamera>({c}), runner.upload(in));
  std::vector<Ray> result;
  for (size_t i = 0; i < out.size(); i += 6)
    result.push_back({{out[i], out[i + 1], out[i + 2]}, {out[i + 3], out[i + 4], out[i + 5]}});
  return result;
}

void expect_near(dvec3 a, dvec3 b, double bound) {
  EXPECT_LT(glm::length(a - b), bound) << a.x << " " << a.y << " " << a.z;
}

TEST(Camera, CentreAndCorners) {
  // Pixel (4, 3) with a film sample of 0 in the box filter is the middle of the film; (0, 0) its upper left corner.
  const auto r = rays(camera(), {4, 3, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 7, 5, 1, 1, 0, 0});
  expect_near(r[0].origin, {1, 2, 3}, 1e-6);
  expect_near(r[0].direction, {1, 0, 0}, 1e-6);
  expect_near(r[1].direction, glm::normalize(dvec3(1, 0.6, -0.8)), 1e-6);
  expect_near(r[2].direction, glm::normalize(dvec3(1, -0.6, 0.8)), 1e-6);
}

TEST(Camera, LensKeepsThePlaneInFocus) {
  WCamera c = camera();
  std::vector<float> in;
  Random random(1);
  for (int i = 0; i < 200; ++i)
    in.insert(in.end(), {6, 1, 0.25f, 0.75f, random.uniform_float(), random.uniform_float()});
  const Ray sharp = rays(c, in)[0];
  const dvec3 target = sharp.origin + sharp.direction * (4 / sharp.direction.x);
  c.aperture = 0.25f;
  double widest = 0;
  for (const Ray& r : rays(c, in)) {
    expect_near(r.origin + r.direction * (4 / r.direction.x), target, 1e-5);
    EXPECT_NEAR(glm::length(r.direction), 1, 1e-6);
    EXPECT_NEAR(r.origin.x, 1, 1e-6);
    widest = std::max(widest, glm::length(r.origin - dvec3(1, 2, 3)));
  }
  EXPECT_LE(widest, 0.25001);
  EXPECT_GT(widest, 0.22);
}

TEST(Camera, OrthographicRaysAreParallel) {
  WCamera c = camera();
  c.kind = 1;
  const auto r = rays(c, {0, 0, 0, 0, 0, 0, 4, 3, 0, 0, 0, 0});
  expect_near(r[0].origin, {1, 2.6, 2.2}, 1e-6);
  expect_near(r[0].direction, {1, 0, 0}, 1e-6);
  expect_near(r[1].origin, {1, 2, 3}, 1e-6);
}

TEST(Camera, TentFilterHasTheVarianceOfATent) {
  WCamera c = camera();
  c.kind = 1;
  for (const int filter : {0, 1}) {
    c.filter = filter;
    std::vector<float> in;
    constexpr int kCount = 4096;
    for (int i = 0; i < kCount; ++i) in.insert(in.end(), {4, 3, (i + 0.5f) / kCount, 0, 0, 0});
    double mean = 0, square = 0, widest = 0;
    for (const Ray& r : rays(c, in)) {
      const double offset = (r.origin.z - 3) / 0.2 - 0.5;  // pixels of 2 * 0.8 / 8
      mean += offset / kCount;
      square += offset * offset / kCount;
      widest = std::max(widest, std::abs(offset));
    }
    EXPECT_NEAR(mean, 0, 1e-3);
    EXPECT_NEAR(square, filter ? 1.0 / 6 : 1.0 / 12, 1e-3);
    EXPECT_NEAR(widest, filter ? 1 : 0.5, 0.03);
  }
}

}  // namespace
}  // namespace wale
