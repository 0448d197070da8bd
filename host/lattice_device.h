#pragma once
#include <memory>
#include <span>
#include <vector>

#include "host/lattice_tables.h"

namespace wale {

/// Lattices and tile tables on the device.
struct LatticeDevice {
  Buffer<float> lattice;
  Buffer<uint32_t> tiles;
  uint32_t patch_bits = 0;

  LatticeDevice() = default;
  LatticeDevice(const Device& device, const LatticeTables& tables);
  size_t bytes() const { return lattice.bytes() + tiles.bytes(); }

  /// Fills in the stored vertices of these runs: x, y, z and W_FRAME_WORDS each.
  void warp(const Device& device, std::span<const StoredRun> runs, const Buffer<float>& points,
            const Buffer<float>& frames) const;

  /// Boxes of the leaves (numbers without W_LEAF_PROCEDURAL), and how many mitres inside them are bent too far, or have
  /// edges too short, for procedural leaves.
  std::vector<Box> boxes(const Device& device, const std::vector<uint32_t>& leaves, Joints joints,
                         uint32_t& tight) const;
};

}  // namespace wale
