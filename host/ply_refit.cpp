#include "host/ply_refit.h"

#include "host/ply_tree.h"
#include "host/program.h"

namespace wale {
PlyRefit::PlyRefit(const Device& device, const Buffer<uint32_t>& runs, const Buffer<float>& positions,
                   const WideTree& wide, const PlyTree& tree, const LeafSteps& steps)
    : runs_(runs), steps_(steps), level_offset_(wide.level_offset), parts_(tree.leaves.parts()) {
  const cl::Program program = build_program(device, "pack.cl");
  leaves_ = cl::Kernel(program, "refit_leaves");
  leaves_.setArg(0, runs_.cl());
  leaves_.setArg(1, positions.cl());
  leaves_.setArg(6, uint32_t(tree.form.joints));
  leaves_.setArg(7, tree.nodes.cl());
  leaves_.setArg(8, steps_.cl());
  nodes_ = cl::Kernel(program, "refit_nodes");
  nodes_.setArg(0, tree.nodes.cl());
}

void PlyRefit::run(const Device& device) {
  if (patches() == 0) return;
  steps_.measure(device, parts_);
  for (const LeafBuffers::Part& part : parts_) {
    leaves_.setArg(2, part.words.cl());
    leaves_.setArg(3, part.first_number);
    leaves_.setArg(4, part.first_leaf);
    leaves_.setArg(5, part.leaves);
    device.queue().enqueueNDRangeKernel(leaves_, cl::NullRange, device.global(part.leaves), device.local());
  }
  for (size_t level = level_offset_.size() - 2; level > 0; --level) {
    const uint32_t first = level_offset_[level], count = level_offset_[level + 1] - first;
    nodes_.setArg(1, first);
    nodes_.setArg(2, count);
    device.queue().enqueueNDRangeKernel(nodes_, cl::NullRange, device.global(count), device.local());
  }
}

}  // namespace wale
