#pragma once
#include <cstdint>

#include "shared/joints.h"
#include "shared/vertices.h"
#include "shared/wale_types.h"

namespace wale {

/// How segments meet: W_JOINTS_* of kernels/shared/joints.h.
enum class Joints : uint32_t { open = W_JOINTS_OPEN, capsule = W_JOINTS_CAPSULE, mitre = W_JOINTS_MITRE };

/// How stored leaves keep their points: kernels/shared/vertices.h. Kernels that read them are built for one.
enum class Vertices : uint32_t { full = W_VERTICES_FULL, quantised = W_VERTICES_QUANTISED };

/// What is decided when leaves are packed.
struct LeafForm {
  Joints joints = Joints::mitre;
  Vertices vertices = Vertices::full;

  LeafForm() = default;
  LeafForm(Joints j, Vertices v = Vertices::full) : joints(j), vertices(v) {}
  bool operator==(const LeafForm&) const = default;
  bool quantised() const { return vertices == Vertices::quantised; }

  /// S of a stored leaf: points with what fills their rows up.
  uint32_t stride(uint32_t intervals, uint32_t plies) const {
    const uint32_t points = (intervals + 3) * plies;
    return quantised() ? (points + 7) / 8 * 8 : (points + 3) / 4 * 4;
  }
  /// Words of a stored leaf, a multiple of 4.
  uint32_t words(uint32_t intervals, uint32_t plies) const {
    return quantised() ? W_QUANTISED_LEAF_HEADER + 3 * stride(intervals, plies) / 2
                       : W_LEAF_HEADER + 3 * stride(intervals, plies);
  }
};

}  // namespace wale
