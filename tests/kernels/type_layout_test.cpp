// The shared structs have the same size on both sides.
#include <gtest/gtest.h>

#include "host/program.h"
#include "shared/wale_types.h"

namespace wale {
namespace {

TEST(TypeLayout, SizesAgreeBetweenHostAndDevice) {
  const Device device = Device::open();
  const cl::Program program = build_program_text(device, R"(
#include "shared/wale_types.h"
__kernel void sizes(__global uint* out) {
  if (get_global_id(0) != 0) return;
  out[0] = sizeof(WAnchor); out[1] = sizeof(WGrid); out[2] = sizeof(WPlyMaterial); out[3] = sizeof(WSurfaceMaterial);
  out[4] = sizeof(WLight); out[5] = sizeof(WSphere); out[6] = sizeof(WEnvironment); out[7] = sizeof(WCamera);
  out[8] = sizeof(WFrame); out[9] = sizeof(WFibreMaterial);
  out[10] = sizeof(WFibreDetail); out[11] = sizeof(WTileVertex); out[12] = sizeof(WLatticeRun);
}
)");
  Buffer<uint32_t> out(device, 13);
  cl::Kernel kernel(program, "sizes");
  kernel.setArg(0, out.cl());
  device.queue().enqueueNDRangeKernel(kernel, cl::NullRange, device.global(1), device.local());
  const std::vector<uint32_t> expected = {sizeof(WAnchor),          sizeof(WGrid),        sizeof(WPlyMaterial),
                                          sizeof(WSurfaceMaterial), sizeof(WLight),       sizeof(WSphere),
                                          sizeof(WEnvironment),     sizeof(WCamera),      sizeof(WFrame),
                                          sizeof(WFibreMaterial),   sizeof(WFibreDetail), sizeof(WTileVertex),
                                          sizeof(WLatticeRun)};
  EXPECT_EQ(out.read(device), expected);
}

}  // namespace
}  // namespace wale
