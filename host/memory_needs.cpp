#include "host/memory_needs.h"

#include <algorithm>
#include <cmath>

#include "geom/error.h"
#include "host/film_device.h"
#include "host/lattice_fabrics.h"
#include "host/leaf_buffers.h"
#include "host/world.h"

namespace wale {
namespace {

// Per patch of a tree of 16-wide nodes that are two thirds full.
constexpr uint64_t kTreeBytes = W_NODE_WORDS * 4 / 10 + 4;
// What is gone before the rays: per vertex its anchor, flags and position, per patch its run and box.
constexpr uint64_t kWarpBytes = sizeof(WAnchor) + 1, kPackBytes = 40;

std::string size_text(uint64_t bytes) {
  return bytes < 1000000000 ? fmt::format("{:.1f} MB", 1e-6 * double(bytes))
                            : fmt::format("{:.1f} GB", 1e-9 * double(bytes));
}

}  // namespace

std::vector<MemoryNeed> memory_needs(const World& world, const Features& features, uint32_t pool,
                                     const DeviceTraits& traits) {
  uint64_t vertices = 0, patches = 0, leaves = 0, lattices = 0, anchors = 0;
  const LeafForm form(Joints::mitre, features.quantised_vertices ? Vertices::quantised : Vertices::full);
  for (const Fabric& fabric : world.fabrics) {
    vertices += fabric.anchors.size();
    anchors += fabric.anchors.size();
    patches += fabric.patches.size();
    for (const Patch& patch : fabric.patches) leaves += 4 * form.words(patch.intervals, fabric.runs[patch.run].plies);
    for (const LatticeChart& chart : fabric.lattice) {
      lattices += chart.lattice.position.size() * W_LATTICE_WORDS * 4;
      const uint32_t plies = uint32_t(chart.tile.plies);
      const uint64_t tiles = uint64_t(chart.lattice.tiles.x) * uint64_t(chart.lattice.tiles.y);
      for (const TileYarn& yarn : chart.tile.yarns) {
        const uint32_t pieces = patches_of(yarn, plies), intervals = (yarn.samples + pieces - 1) / pieces;
        patches += tiles * pieces;
        if (!fabric.procedural) leaves += tiles * pieces * 4 * form.words(intervals, plies);
      }
    }
    if (!fabric.procedural) vertices += lattice_vertices(fabric);
  }
  const WCamera& camera = world.camera;
  const uint64_t pixels = padded_pixels(camera.width, camera.height);
  const uint64_t pixel_bytes = kScrambles * sizeof(w_float4) + (features.four_vectors() ? 4 * sizeof(w_float4) + 4 : 0);
  const uint64_t path_bytes = 10 * sizeof(w_float4) + 8 + 9 * 4 + (features.aovs ? 4 * sizeof(w_float4) : 0) +
                              (features.gradients ? 3 * W_GRADIENT_COUNT * sizeof(w_float4) : 0);
  const uint64_t path_buffer = (features.four_vectors() ? 4 : 1) * sizeof(w_float4);
  const double fits = std::sqrt(std::min(1.0, 0.5 * double(traits.global_bytes) / double(pixels * pixel_bytes)));
  const std::string fewer = "fewer repeats, a coarser gauge or a larger tolerance";
  std::vector<MemoryNeed> needs = {
      {"film", pixels * pixel_bytes, 0,
       fmt::format("a film.size of at most {} x {}", int(camera.width * fits), int(camera.height * fits))},
      {"path state", pool * path_bytes, pool * path_buffer,
       fmt::format("an integrator.pool of at most {}",
                   std::min(traits.global_bytes / 2 / path_bytes, traits.max_alloc_bytes / path_buffer))},
      {"ply vertices", vertices * W_FRAME_WORDS * 4, vertices * W_FRAME_WORDS * 4, fewer},
      {"ply leaves", leaves, leaves <= LeafBuffers::most_bytes(traits.max_alloc_bytes) ? 0 : leaves, fewer},
      {"lattices", lattices, lattices, "fewer repeats, a coarser gauge or fewer lattice cells"},
      // A quantised tree is made from the other one, which goes afterwards.
      {"ply tree", patches * kTreeBytes * (features.simt ? 2 : 1), patches * kTreeBytes, fewer},
      {"warp and pack", anchors * kWarpBytes + vertices * 12 + patches * kPackBytes, anchors * sizeof(WAnchor), fewer},
      {"ply colours", world.ply_colors.size() * 4, world.ply_colors.size() * 4, "fewer colours"},
      {"triangles", world.triangles.size() * 4 * 2, world.triangles.size() * 4, "simpler props"},
      {"environment",
       world.environment_tables.texels.size() * sizeof(w_float4) + world.environment_tables.cdf.size() * 4,
       world.environment_tables.texels.size() * sizeof(w_float4), "a smaller environment image"}};
  std::stable_sort(needs.begin(), needs.end(), [](const auto& a, const auto& b) { return a.bytes > b.bytes; });
  return needs;
}

void require_memory(const Device& device, const std::vector<MemoryNeed>& needs) {
  const DeviceTraits& traits = device.traits();
  uint64_t all = 0;
  for (const auto& need : needs) all += need.bytes;
  if (all > traits.global_bytes) {
    std::string largest;
    for (size_t i = 0; i < std::min<size_t>(3, needs.size()); ++i)
      largest += fmt::format("{}{} {}", i ? ", " : "", needs[i].name, size_text(needs[i].bytes));
    user_error("device {} ({}) has {}, the scene needs {}: {} and less; use {}, or another device (see `wale devices`)",
               device.number(), traits.name, size_text(traits.global_bytes), size_text(all), largest,
               needs.front().instead);
  }
  for (const auto& need : needs)
    if (need.largest > traits.max_alloc_bytes)
      user_error(
          "device {} ({}) holds at most {} in one buffer, {} would need {}; use {}, or another device (see `wale "
          "devices`)",
          device.number(), traits.name, size_text(traits.max_alloc_bytes), need.name, size_text(need.largest),
          need.instead);
}

}  // namespace wale
