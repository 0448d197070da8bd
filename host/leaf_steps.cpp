#include "host/leaf_steps.h"

#include "host/program.h"
#include "shared/vertices.h"

namespace wale {

LeafSteps::LeafSteps(const Device& device, uint32_t fabrics, const Buffer<uint32_t>& runs,
                     const Buffer<float>& positions)
    : measures_(device, size_t(fabrics) * 2 * W_STEP_WORDS) {
  if (fabrics == 0) return;
  measure_ = cl::Kernel(build_program(device, "pack.cl"), "measure_leaves");
  measure_.setArg(0, runs.cl());
  measure_.setArg(1, positions.cl());
  measure_.setArg(6, measures_.cl());
}

void LeafSteps::measure(const Device& device, std::span<const LeafBuffers::Part> parts) {
  if (measures_.count() == 0) return;
  measures_.fill(device, 0);
  for (const LeafBuffers::Part& part : parts) {
    measure_.setArg(2, part.words.cl());
    measure_.setArg(3, part.first_number);
    measure_.setArg(4, part.first_leaf);
    measure_.setArg(5, part.leaves);
    device.queue().enqueueNDRangeKernel(measure_, cl::NullRange, device.large_global(part.leaves), device.local());
  }
}

}  // namespace wale
