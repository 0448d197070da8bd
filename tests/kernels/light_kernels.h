#pragma once
#include <cmath>
#include <string>
#include <vector>

#include "host/light_tables.h"
#include "tests/kernels/kernel_runner.h"
#include "tests/kernels/statistics.h"

namespace wale::test {

inline const char* kLightKernels = R"(
#include "lights.clh"
#define LIGHT_ARGS __global const WLight* light, __global const float* cdf, __global const float* triangles,      \
    __global const int* index, __global const WEnvironment* env, __global const float4* texels,                   \
    __global const float* env_cdf, uint lights
#define LIGHTS {light, cdf, triangles, index, *env, texels, env_cdf, lights}
static inline w_real3 vec(__global const float* p) { return (w_real3)(p[0], p[1], p[2]); }
/* From one point, 4 numbers a sample -> direction, distance, radiance, pdf, light */
__kernel void samples(LIGHT_ARGS, __global const float* point, __global const float4* u, __global w_real* out,
                      uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  const WLights l = LIGHTS;
  const WLightSample s = w_light_sample(&l, vec(point), u[i]);
  vstore3(s.direction, 0, out + 9 * i);
  out[9 * i + 3] = s.distance;
  vstore3(s.radiance, 0, out + 9 * i + 4);
  out[9 * i + 7] = s.pdf;
  out[9 * i + 8] = s.light;
}
/* Environment, a direction each -> density, radiance */
__kernel void environment(LIGHT_ARGS, __global const float* direction, __global w_real* out, uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  const WLights l = LIGHTS;
  const w_real3 d = vec(direction + 3 * i);
  out[4 * i] = w_environment_pdf(&l, d);
  vstore3(w_environment_radiance(&l, d), 0, out + 4 * i + 1);
}
/* Densities of hits: light, direction, distance, normal (8 floats) from one point. */
__kernel void densities(LIGHT_ARGS, __global const float* point, __global const float* hit, __global w_real* out,
                        uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  const WLights l = LIGHTS;
  __global const float* h = hit + 8 * i;
  out[i] = light[(uint)h[0]].kind == W_LIGHT_SPHERE
               ? w_light_pdf_sphere(&l, (uint)h[0], vec(point), vec(h + 1), h[4])
               : w_light_pdf_triangle(&l, (uint)h[0], vec(h + 5), vec(h + 1), h[4]);
}
)";

/// The lights of a test on the device, and its kernels.
class LightScene {
 public:
  LightScene(const LightTables& tables, const WEnvironment& environment, const EnvironmentTables& image,
             bool twice = false)
      : runner_(kLightKernels, twice),
        lights_(runner_.upload(tables.lights)),
        cdf_(runner_.upload(tables.cdf)),
        triangles_(runner_.upload(tables.triangles)),
        index_(runner_.upload(tables.triangle_index)),
        environment_(runner_.upload<WEnvironment>({environment})),
        texels_(runner_.upload(image.texels)),
        env_cdf_(runner_.upload(image.cdf)) {}

  template <typename... Args>
  std::vector<double> run(const char* kernel, size_t items, size_t outputs, const Args&... args) const {
    return runner_.run(kernel, items, outputs, lights_, cdf_, triangles_, index_, environment_, texels_, env_cdf_,
                       cl_uint(lights_.count()), args...);
  }
  std::vector<double> samples(const std::vector<float>& point, const std::vector<float>& u) const {
    return run("samples", u.size() / 4, 9, runner_.upload(point), runner_.upload(u));
  }
  const KernelRunner& runner() const { return runner_; }

 private:
  KernelRunner runner_;
  Buffer<WLight> lights_;
  Buffer<float> cdf_, triangles_;
  Buffer<int32_t> index_;
  Buffer<WEnvironment> environment_;
  Buffer<w_float4> texels_;
  Buffer<float> env_cdf_;
};

inline WEnvironment no_environment() {
  WEnvironment e{};
  e.light = -1;
  e.to_local[0] = {1, 0, 0, 0};
  e.to_local[1] = {0, 1, 0, 0};
  e.to_local[2] = {0, 0, 1, 0};
  return e;
}

/// count points of an additive recurrence in four dimensions (M. Roberts 2018, R4): low discrepancy, not ours.
inline std::vector<float> spread_numbers(size_t count) {
  const double g = 1.1673039782614187;  // root of x^5 = x + 1
  std::vector<float> u;
  for (size_t i = 0; i < count; ++i)
    for (int k = 1; k <= 4; ++k) {
      const float value = float(std::fmod(0.5 + double(i + 1) * std::pow(g, -k), 1.0));
      u.push_back(value < 1 ? value : 0);
    }
  return u;
}

/// Mean over samples of value(direction, radiance)/pdf; samples without density count as 0.
template <typename Value>
double estimate(const std::vector<double>& samples, const Value& value) {
  double sum = 0;
  for (size_t i = 0; i < samples.size() / 9; ++i) {
    const double* s = &samples[9 * i];
    if (s[7] > 0) sum += value(dvec3(s[0], s[1], s[2]), dvec3(s[4], s[5], s[6])) / s[7];
  }
  return sum / (samples.size() / 9.0);
}

}  // namespace wale::test
