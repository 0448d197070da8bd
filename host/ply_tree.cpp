#include "host/ply_tree.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <utility>

#include "geom/error.h"
#include "host/large_pages.h"
#include "host/program.h"
#include "shared/wale_types.h"

namespace wale {
namespace {

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

void write_header(const PlyPatch& patch, const LeafForm& form, uint32_t* leaf) {
  const uint32_t lanes = patch.intervals * patch.plies;
  leaf[W_LEAF_RADIUS] = std::bit_cast<uint32_t>(patch.radius);
  leaf[W_LEAF_SEGMENT] = patch.first_vertex + patch.first;
  leaf[W_LEAF_STRIDE] = patch.count;
  leaf[W_LEAF_MATERIAL] = patch.material;
  leaf[W_LEAF_LAYOUT] = patch.plies | lanes << 8 | form.stride(patch.intervals, patch.plies) << 16 |
                        (form.quantised() ? W_LAYOUT_QUANTISED : 0);
  leaf[W_LEAF_TAU] = std::bit_cast<uint32_t>(patch.tau);
  leaf[W_LEAF_CELL] = patch.cell;
  leaf[W_LEAF_FABRIC] = patch.fabric;
  leaf[W_LEAF_PLY] = patch.first_ply;
}

// Leaf by leaf in pieces, so that the host never holds all leaves.
void write_headers(const Device& device, std::span<const PlyPatch> patches, const PlyTree& tree) {
  constexpr size_t kPiece = 1u << 14;
  std::vector<uint32_t> words;
  for (const LeafBuffers::Part& part : tree.leaves.parts()) {
    const auto place = [&](size_t i) { return size_t(tree.leaf_offset[i] - part.first_number) * 4; };
    const size_t end = part.first_leaf + part.leaves;
    for (size_t first = part.first_leaf; first < end; first += kPiece) {
      const size_t last = std::min(first + kPiece, end), begin = place(first);
      const PlyPatch& end_patch = patches[last - 1];
      words.assign(place(last - 1) + tree.form.words(end_patch.intervals, end_patch.plies) - begin, 0);
      for (size_t i = first; i < last; ++i) write_header(patches[i], tree.form, words.data() + place(i) - begin);
      device.queue().enqueueWriteBuffer(part.words.cl(), CL_TRUE, begin * 4, words.size() * 4, words.data());
    }
  }
}

void place_leaves(const Device& device, uint32_t nodes, const PlyTree& tree) {
  cl::Kernel place(build_program(device, "pack.cl"), "place_leaves");
  place.setArg(0, tree.nodes.cl());
  place.setArg(4, nodes);
  for (const LeafBuffers::Part& part : tree.leaves.parts()) {
    place.setArg(1, part.words.cl());
    place.setArg(2, part.first_number);
    place.setArg(3, part.numbers);
    device.queue().enqueueNDRangeKernel(place, cl::NullRange, device.large_global(size_t(nodes) * W_NODE_WIDTH),
                                        device.local());
  }
}

void refuse_if_too_far(const PlyPatch& patch, const Box& box) {
  for (int k = 0; k < 3; ++k)
    if (!(box.lo[k] <= box.hi[k] && box.lo[k] >= -kLargestCoordinate && box.hi[k] <= kLargestCoordinate &&
          patch.radius <= kLargestCoordinate))
      user_error(
          "fabric {}: a ply of radius {:.3g} m reaches from {:.3g} to {:.3g} m; {:.0e} m from the middle of the "
          "scene is the most that can be traced, in finite numbers: scale the scene down",
          patch.fabric, patch.radius, box.lo[k], box.hi[k], kLargestCoordinate);
}

}  // namespace

PlyTree build_ply_tree(const Device& device, std::span<const PlyPatch> patches, const Buffer<float>& positions,
                       std::span<const Box> group_box, bool updatable, ProceduralLeaves procedural, LeafForm form) {
  if (updatable && !group_box.empty()) bug("ply tree: a tree of cells cannot be refitted");
  if (updatable && !procedural.number.empty()) bug("ply tree: procedural leaves cannot be refitted");
  PlyTree tree;
  tree.form = form;
  const double start = now();
  std::vector<uint32_t> words;
  uint32_t fabrics = 0;
  words.reserve(patches.size());
  for (const PlyPatch& patch : patches) {
    if (patch.plies < 1 || patch.plies > 8 || patch.intervals < 1 || patch.intervals * patch.plies > W_LEAF_LANES ||
        patch.first + patch.intervals >= patch.count)
      bug("ply tree: patch of {} x {} segments at {} of {} vertices", patch.intervals, patch.plies, patch.first,
          patch.count);
    words.push_back(form.words(patch.intervals, patch.plies));
    fabrics = std::max(fabrics, patch.fabric + 1);
  }
  tree.leaf_offset.reserve(patches.size());
  tree.leaves = LeafBuffers(device, words, procedural.number.empty() ? 1u << 28 : W_LEAF_PROCEDURAL, tree.leaf_offset);
  words = {};
  std::vector<uint32_t> run_of;
  run_of.reserve(4 * patches.size());
  for (size_t i = 0; i < patches.size(); ++i)
    run_of.insert(run_of.end(),
                  {tree.leaf_offset[i], patches[i].first_vertex, patches[i].count, patches[i].ghost_ends});
  write_headers(device, patches, tree);
  std::vector<Box> boxes = std::move(procedural.box);
  boxes.insert(boxes.begin(), patches.size(), Box{});
  const Buffer<uint32_t> runs(device, run_of);
  run_of = {};
  LeafSteps steps(device, form.quantised() ? fabrics : 0, runs, positions);
  if (!patches.empty()) {
    steps.measure(device, tree.leaves.parts());
    const Buffer<float> box_buffer(device, 6 * patches.size());
    cl::Kernel pack(build_program(device, "pack.cl"), "pack_leaves");
    pack.setArg(0, runs.cl());
    pack.setArg(1, positions.cl());
    pack.setArg(6, uint32_t(form.joints));
    pack.setArg(7, box_buffer.cl());
    pack.setArg(8, steps.cl());
    for (const LeafBuffers::Part& part : tree.leaves.parts()) {
      pack.setArg(2, part.words.cl());
      pack.setArg(3, part.first_number);
      pack.setArg(4, part.first_leaf);
      pack.setArg(5, part.leaves);
      device.queue().enqueueNDRangeKernel(pack, cl::NullRange, device.large_global(part.leaves), device.local());
    }
    const std::vector<float> flat = box_buffer.read(device);
    for (size_t i = 0; i < patches.size(); ++i) {
      std::copy_n(flat.begin() + 6 * i, 3, boxes[i].lo);
      std::copy_n(flat.begin() + 6 * i + 3, 3, boxes[i].hi);
      refuse_if_too_far(patches[i], boxes[i]);
    }
  }
  for (const Box& box : boxes) join(tree.bounds, box);
  if (!boxes.empty()) tree.root = 0;
  tree.leaf_offset.insert(tree.leaf_offset.end(), procedural.number.begin(), procedural.number.end());
  tree.pack_seconds = now() - start;

  std::vector<uint32_t> cells;
  if (!group_box.empty())
    for (const PlyPatch& patch : patches) cells.push_back(patch.cell);
  const WideTree wide = build_wide_tree(boxes, tree.leaf_offset, cells, group_box);
  tree.nodes = in_large_pages(device, wide.words);
  // Read by rays that go up from their own leaf, and by refit.
  if (!patches.empty() && (device.traits().traversal == Traversal::lanes || updatable))
    place_leaves(device, uint32_t(wide.nodes()), tree);
  tree.node_cell = Buffer<uint32_t>(device, group_box.empty() ? std::vector<uint32_t>{} : wide.node_cell);
  if (updatable) tree.refit = std::make_unique<PlyRefit>(device, runs, positions, wide, tree, steps);
  tree.node_count = wide.nodes();
  if (device.traits().traversal == Traversal::simt && group_box.empty()) {
    tree.quantised = QuantisedTree(device, wide, tree.nodes);
    if (!updatable) tree.nodes = Buffer<uint32_t>(device, 0);
  }
  tree.build_seconds = now() - start - tree.pack_seconds;
  return tree;
}

void refit(const Device& device, PlyTree& tree) {
  if (!tree.refit) bug("ply tree: not built to be updatable");
  tree.refit->run(device);
  if (tree.quantised.bytes()) tree.quantised.requantise(device, tree.nodes);
  uint32_t root[W_NODE_WORDS];
  device.queue().enqueueReadBuffer(tree.nodes.cl(), CL_TRUE, 0, sizeof(root), root);
  tree.bounds = Box{};
  for (int k = 0; k < 3; ++k)
    for (int slot = 0; slot < W_NODE_WIDTH; ++slot) {
      if (root[W_NODE_CHILD + slot] == W_NONE) continue;
      const float lo = std::bit_cast<float>(root[16 * k + slot]), hi = std::bit_cast<float>(root[48 + 16 * k + slot]);
      if (!(lo >= -kLargestCoordinate && hi <= kLargestCoordinate))
        user_error(
            "fabric: moved, a ply reaches from {:.3g} to {:.3g} m; {:.0e} m from the middle of the scene is "
            "the most that can be traced, in finite numbers",
            lo, hi, kLargestCoordinate);
      tree.bounds.lo[k] = std::min(tree.bounds.lo[k], lo);
      tree.bounds.hi[k] = std::max(tree.bounds.hi[k], hi);
    }
}

}  // namespace wale
