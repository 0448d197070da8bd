#include "host/lattice_fabrics.h"

#include <utility>

#include "geom/error.h"

namespace wale {
namespace {

constexpr size_t kMostIds = 0xfffffff0;  // W_NEIGHBOUR_NONE of the kernels

// Without a copy where `all` is empty, as it is for the one large fabric of most scenes.
template <typename T>
void append(std::vector<T>& all, std::vector<T>&& more) {
  if (all.empty())
    all = std::move(more);
  else
    all.insert(all.end(), more.begin(), more.end());
}

}  // namespace

size_t lattice_vertices(const Fabric& fabric) {
  size_t vertices = 0;
  for (const LatticeChart& chart : fabric.lattice)
    for (const TileYarn& yarn : chart.tile.yarns) {
      const ivec2 tiles = chart.lattice.tiles;
      const size_t ends = chart.lattice.wrap[yarn.axis] ? 3 : 1;
      vertices +=
          size_t(tiles[1 - yarn.axis]) * size_t(chart.tile.plies) * (size_t(tiles[yarn.axis]) * yarn.samples + ends);
    }
  return vertices;
}

LatticeFabrics place_lattices(const Device& device, std::vector<LatticeInput> inputs, dvec3 origin, Joints joints,
                              size_t first_vertex, size_t& plies) {
  std::vector<bool> stored;
  for (LatticeInput& input : inputs) {
    stored.push_back(!input.fabric->procedural);
    input.first_ply = uint32_t(plies);
    plies += input.fabric->report.plies;
  }
  uint32_t all_tight = 0;
  for (;;) {
    LatticeFabrics out;
    out.tight_joints = all_tight;
    size_t next = first_vertex;
    for (const bool procedural : {false, true})
      for (size_t i = 0; i < inputs.size(); ++i) {
        if (stored[i] == procedural) continue;
        inputs[i].first_vertex = uint32_t(next);
        next += lattice_vertices(*inputs[i].fabric);
        if (!procedural) out.stored_vertices = next - first_vertex;
      }
    if (next >= kMostIds)
      user_error("fabrics: {:.3g} ply vertices are more than can be numbered; use fewer repeats", double(next));
    const LatticeTables tables(inputs, origin, joints);
    out.device = LatticeDevice(device, tables);
    bool again = false;
    for (size_t i = 0; i < inputs.size(); ++i) {
      const uint32_t fabric = inputs[i].number;
      if (stored[i]) {
        const auto runs = tables.runs(fabric);
        const auto patches = tables.patches(fabric);
        out.runs.insert(out.runs.end(), runs.begin(), runs.end());
        out.patches.insert(out.patches.end(), patches.begin(), patches.end());
        continue;
      }
      std::vector<uint32_t> leaves = tables.leaves(fabric);
      uint32_t tight = 0;
      std::vector<Box> boxes = out.device.boxes(device, leaves, joints, tight);
      if (tight > 0) {
        all_tight += tight;
        stored[i] = again = true;
        continue;
      }
      for (uint32_t& leaf : leaves) leaf |= W_LEAF_PROCEDURAL;
      append(out.procedural.number, std::move(leaves));
      append(out.procedural.box, std::move(boxes));
      out.segments += inputs[i].fabric->report.segments;
    }
    if (!again) return out;
  }
}

}  // namespace wale
