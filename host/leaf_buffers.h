#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "host/device.h"

namespace wale {

/// Patch leaves on the device, in one buffer or, where the device allows none so large, in up to W_LEAF_BUFFERS. Leaf
/// numbers count 16-byte units over all of them: buffer b holds those from b * 2^number_bits() on. No leaf lies in two.
class LeafBuffers {
 public:
  /// Leaves that lie in one buffer.
  struct Part {
    Buffer<uint32_t> words;
    uint32_t first_leaf = 0, leaves = 0;
    uint32_t first_number = 0;
  };

  LeafBuffers() = default;
  /// Room for leaves of `leaf_words` words each (multiples of 4), zeros behind the last; appends their numbers to `numbers`. Throws
  /// a device error when they do not fit W_LEAF_BUFFERS buffers, or would have numbers from `end_of_numbers` on.
  LeafBuffers(const Device& device, std::span<const uint32_t> leaf_words, uint64_t end_of_numbers,
              std::vector<uint32_t>& numbers);

  const std::vector<Part>& parts() const { return parts_; }
  bool split() const { return parts_.size() > 1; }
  uint32_t number_bits() const { return bits_; }
  size_t bytes() const;
  /// The only buffer; a bug where there are several.
  const cl::Buffer& cl() const;
  /// All words: the leaf of number i starts at 4 i.
  std::vector<uint32_t> read(const Device& device) const;

  /// Sets the arguments of W_LEAF_PARAMS (stages/scene_args.clh), for kernels that take several; returns the next
  /// index.
  cl_uint bind_others(cl::Kernel& kernel, cl_uint first) const;

  /// Bytes of leaves that several buffers of a device are sure to hold.
  static uint64_t most_bytes(uint64_t max_alloc_bytes);

 private:
  std::vector<Part> parts_;
  uint32_t bits_ = 32;
};

}  // namespace wale
