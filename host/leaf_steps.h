#pragma once
#include <cstdint>
#include <span>

#include "host/device.h"
#include "host/leaf_buffers.h"

namespace wale {

/// Steps that quantised points count in (kernels/shared/vertices.h), by fabric and kind of curve. They follow from
/// where the points lie alone, so that a tree that was refitted holds the same points as one that is built anew.
class LeafSteps {
 public:
  LeafSteps() = default;
  /// `fabrics`: their number, 0 where points are floats and nothing is measured. `runs` as kernel pack_leaves takes
  /// them.
  LeafSteps(const Device& device, uint32_t fabrics, const Buffer<uint32_t>& runs, const Buffer<float>& positions);

  /// Measures what `positions` holds now, before leaves are packed, whose headers must be there; returns before the
  /// device is done.
  void measure(const Device& device, std::span<const LeafBuffers::Part> parts);
  const cl::Buffer& cl() const { return measures_.cl(); }
  /// On the device; 0 where points are floats.
  size_t bytes() const { return measures_.count() * sizeof(uint32_t); }

 private:
  Buffer<uint32_t> measures_;
  cl::Kernel measure_;
};

}  // namespace wale
