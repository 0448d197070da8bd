// What has to survive compiler options that assume finite arithmetic (docs/numerics.md): a sample that is not finite is
// counted and left out, and a ray that is not finite misses.
#include <gtest/gtest.h>

#include <cmath>

#include "host/program.h"
#include "shared/wale_types.h"

namespace wale::test {
namespace {

class FastMath : public testing::TestWithParam<const char*> {};

TEST_P(FastMath, SamplesThatAreNotFiniteAreCountedAndLeftOut) {
  const Device device = Device::open();
  cl::Program program = build_program(device, "stages/accumulate.cl", GetParam());
  cl::Kernel kernel(program, "accumulate");
  WCamera camera{};
  camera.width = 8, camera.height = 8;
  WFrame frame{};
  frame.samples_in_wave = 1;
  const uint32_t pixels = 64;
  frame.paths = pixels;
  const float kWrong[] = {NAN, -NAN, INFINITY, -INFINITY};
  std::vector<w_float4> samples(pixels, w_float4{1, 1, 1, 0});
  uint32_t wrong = 0;
  for (uint32_t i = 0; i < pixels; i += 5, ++wrong) {
    float* const channels[] = {&samples[i].x, &samples[i].y, &samples[i].z};
    *channels[i % 3] = kWrong[i % 4];
  }
  samples[1].w = NAN;  // no colour: set by the kernel
  const Buffer<uint32_t> wave_tiles(device, std::vector<uint32_t>{0});
  const Buffer<w_float4> radiance(device, samples);
  Buffer<w_float4> film(device, std::vector<w_float4>(pixels * 8, w_float4{0, 0, 0, 0}));
  Buffer<uint32_t> events(device, std::vector<uint32_t>(W_EVENT_COUNT, 0));
  cl_uint index = 0;
  kernel.setArg(index++, frame);
  kernel.setArg(index++, camera);
  kernel.setArg(index++, wave_tiles.cl());
  kernel.setArg(index++, 0u);
  kernel.setArg(index++, pixels);
  kernel.setArg(index++, radiance.cl());
  kernel.setArg(index++, film.cl());
  kernel.setArg(index++, events.cl());
  device.queue().enqueueNDRangeKernel(kernel, cl::NullRange, device.global(pixels), device.local());
  EXPECT_EQ(events.read(device)[W_EVENT_NAN], wrong);
  double sum = 0, count = 0;
  for (const w_float4& slot : film.read(device)) {
    for (const float value : {slot.x, slot.y, slot.z, slot.w}) ASSERT_TRUE(std::isfinite(value));
    sum += slot.x;
    count += slot.w;
  }
  EXPECT_EQ(sum, double(pixels - wrong));
  EXPECT_EQ(count, double(pixels)) << "a sample left out still counts as one";
}

std::string option_name(const testing::TestParamInfo<const char*>& c) {
  const char* const names[] = {"Strict", "FiniteOnly", "FastRelaxed", "MadNoSignedZeros"};
  return names[c.index];
}
INSTANTIATE_TEST_SUITE_P(Options, FastMath,
                         testing::Values("", "-cl-finite-math-only", "-cl-fast-relaxed-math",
                                         "-cl-mad-enable -cl-no-signed-zeros -cl-denorms-are-zero"),
                         option_name);

}  // namespace
}  // namespace wale::test
