#include "host/ply_refit.h"

#include <algorithm>

#include "host/ply_tree.h"
#include "host/program.h"
#include "shared/wale_types.h"

namespace wale {
namespace {

// 16 * node + slot of every leaf, in the order of the leaves.
std::vector<uint32_t> places_of(const WideTree& wide, const std::vector<uint32_t>& leaf_offset) {
  std::vector<uint32_t> places(leaf_offset.size());
  for (uint32_t node = 0; node < wide.nodes(); ++node)
    for (uint32_t slot = 0; slot < W_NODE_WIDTH; ++slot) {
      const uint32_t code = wide.words[size_t(node) * W_NODE_WORDS + 96 + slot];
      if (code == W_NONE || !(code & W_CHILD_LEAF)) continue;
      const auto leaf = std::lower_bound(leaf_offset.begin(), leaf_offset.end(), code & ~W_CHILD_LEAF);
      places[size_t(leaf - leaf_offset.begin())] = node * W_NODE_WIDTH + slot;
    }
  return places;
}

}  // namespace

PlyRefit::PlyRefit(const Device& device, const Buffer<uint32_t>& runs, const Buffer<float>& positions,
                   const std::vector<uint32_t>& leaf_offset, const WideTree& wide, const PlyTree& tree)
    : runs_(runs),
      places_(device, places_of(wide, leaf_offset)),
      parents_(device, wide.parent),
      level_offset_(wide.level_offset),
      parts_(tree.leaves.parts()) {
  const cl::Program program = build_program(device, "pack.cl");
  leaves_ = cl::Kernel(program, "refit_leaves");
  leaves_.setArg(0, runs_.cl());
  leaves_.setArg(1, positions.cl());
  leaves_.setArg(6, places_.cl());
  leaves_.setArg(7, tree.nodes.cl());
  nodes_ = cl::Kernel(program, "refit_nodes");
  nodes_.setArg(0, parents_.cl());
  nodes_.setArg(1, tree.nodes.cl());
}

void PlyRefit::run(const Device& device) {
  if (places_.count() == 0) return;
  for (const LeafBuffers::Part& part : parts_) {
    leaves_.setArg(2, part.words.cl());
    leaves_.setArg(3, part.first_number);
    leaves_.setArg(4, part.first_leaf);
    leaves_.setArg(5, part.leaves);
    device.queue().enqueueNDRangeKernel(leaves_, cl::NullRange, device.global(part.leaves), device.local());
  }
  for (size_t level = level_offset_.size() - 2; level > 0; --level) {
    const uint32_t first = level_offset_[level], count = level_offset_[level + 1] - first;
    nodes_.setArg(2, first);
    nodes_.setArg(3, count);
    device.queue().enqueueNDRangeKernel(nodes_, cl::NullRange, device.global(count), device.local());
  }
}

}  // namespace wale
