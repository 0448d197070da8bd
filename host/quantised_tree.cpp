#include "host/quantised_tree.h"

#include "host/program.h"
#include "shared/wale_types.h"

namespace wale {
namespace {

// Number of each node's first leaf box, then the number of leaves.
std::vector<uint32_t> first_leaves(const WideTree& wide) {
  std::vector<uint32_t> first;
  first.reserve(wide.nodes() + 1);
  uint32_t leaves = 0;
  for (size_t node = 0; node < wide.nodes(); ++node) {
    first.push_back(leaves);
    const uint32_t* codes = wide.words.data() + node * W_NODE_WORDS + W_NODE_CHILD;
    for (int slot = 0; slot < W_NODE_WIDTH; ++slot) leaves += codes[slot] != W_NONE && (codes[slot] & W_CHILD_LEAF);
  }
  first.push_back(leaves);
  return first;
}

}  // namespace

QuantisedTree::QuantisedTree(const Device& device, const WideTree& wide, const Buffer<uint32_t>& nodes) {
  const std::vector<uint32_t> first = first_leaves(wide);
  first_leaf_ = Buffer<uint32_t>(device, first);
  nodes_ = Buffer<uint32_t>(device, wide.nodes() * W_QUANTISED_WORDS);
  leaf_boxes_ = Buffer<uint32_t>(device, size_t(first.back()) * W_LEAF_BOX_WORDS);
  requantise(device, nodes);
  device.queue().finish();  // `nodes` may go away now: not every driver keeps what a launch still reads
}

void QuantisedTree::requantise(const Device& device, const Buffer<uint32_t>& nodes) {
  const uint32_t count = uint32_t(first_leaf_.count() - 1);
  if (count == 0) return;
  cl::Kernel kernel(build_program(device, "quantise.cl"), "quantise_nodes");
  kernel.setArg(0, nodes.cl());
  kernel.setArg(1, first_leaf_.cl());
  kernel.setArg(2, nodes_.cl());
  kernel.setArg(3, leaf_boxes_.cl());
  kernel.setArg(4, count);
  device.queue().enqueueNDRangeKernel(kernel, cl::NullRange, device.large_global(count), device.local());
}

}  // namespace wale
