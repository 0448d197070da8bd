#include "host/leaf_buffers.h"

#include <algorithm>
#include <bit>

#include "geom/error.h"
#include "host/large_pages.h"
#include "shared/wale_types.h"

namespace wale {
namespace {

constexpr uint64_t kUnit = 16;  // bytes
// Masked lanes load their four points too, beyond the last leaf's own.
constexpr uint32_t kTail = W_LEAF_LANES + 3 * 8;
// The end of a buffer stays empty where the next leaf does not fit: less than the largest leaf.
constexpr uint64_t kLargestLeaf = (W_LEAF_HEADER + 3 * (W_LEAF_LANES + 3 * 8)) * 4;

// Leaf numbers per buffer, as a power of two.
uint32_t bits_of_part(uint64_t max_alloc_bytes) {
  const uint64_t room = max_alloc_bytes / kUnit - std::min(max_alloc_bytes / kUnit, kTail * 4 / kUnit);
  return room == 0 ? 0 : uint32_t(std::bit_width(room)) - 1;
}

}  // namespace

LeafBuffers::LeafBuffers(const Device& device, std::span<const uint32_t> leaf_words, uint64_t end_of_numbers,
                         std::vector<uint32_t>& numbers) {
  const DeviceTraits& traits = device.traits();
  uint64_t words = 0;
  for (const uint32_t n : leaf_words) words += n;
  uint64_t part_units = ~0ull;  // all in one
  if ((words + kTail) * 4 > traits.max_alloc_bytes) {
    bits_ = bits_of_part(traits.max_alloc_bytes);
    part_units = 1ull << bits_;
  }
  const auto refuse = [&] {
    device_error("ply tree: leaves of {} MB do not fit {} buffers of {}; use fewer repeats", words * 4 >> 20,
                 W_LEAF_BUFFERS, traits.name);
  };
  if (part_units < kLargestLeaf / kUnit) refuse();

  std::vector<uint64_t> units;  // of every buffer
  uint64_t at = 0;              // inside the last one
  for (uint32_t i = 0; i < leaf_words.size(); ++i) {
    const uint64_t size = leaf_words[i] / 4;
    if (parts_.empty() || at + size > part_units) {
      if (!parts_.empty()) units.push_back(at);
      Part& part = parts_.emplace_back();
      part.first_leaf = i;
      part.first_number = parts_.size() == 1 ? 0 : uint32_t((parts_.size() - 1) << bits_);
      at = 0;
    }
    const uint64_t number = parts_.back().first_number + at;
    if (number + size > end_of_numbers || parts_.size() > W_LEAF_BUFFERS) refuse();
    numbers.push_back(uint32_t(number));
    ++parts_.back().leaves;
    at += size;
  }
  if (parts_.empty()) parts_.emplace_back();
  units.push_back(at);
  for (size_t i = 0; i < parts_.size(); ++i) {
    parts_[i].words = Buffer<uint32_t>(device, units[i] * 4 + kTail);
    ask_for_large_pages(device, parts_[i].words.cl());
    constexpr uint32_t kZeros[kTail] = {};
    device.queue().enqueueWriteBuffer(parts_[i].words.cl(), CL_TRUE, units[i] * 16, sizeof(kZeros), kZeros);
  }
}

size_t LeafBuffers::bytes() const {
  size_t bytes = 0;
  for (const Part& part : parts_) bytes += part.words.bytes();
  return bytes;
}

const cl::Buffer& LeafBuffers::cl() const {
  if (parts_.size() != 1) bug("leaves: asked for the one buffer of {}", parts_.size());
  return parts_.front().words.cl();
}

std::vector<uint32_t> LeafBuffers::read(const Device& device) const {
  std::vector<uint32_t> all;
  for (const Part& part : parts_) {
    const std::vector<uint32_t> words = part.words.read(device);
    all.resize(size_t(part.first_number) * 4);
    all.insert(all.end(), words.begin(), words.end());
  }
  return all;
}

cl_uint LeafBuffers::bind_others(cl::Kernel& kernel, cl_uint first) const {
  for (size_t i = 1; i < W_LEAF_BUFFERS; ++i)
    kernel.setArg(first++, parts_[i < parts_.size() ? i : 0].words.cl());  // those that are not there stand for nothing
  kernel.setArg(first++, bits_);
  return first;
}

uint64_t LeafBuffers::most_bytes(uint64_t max_alloc_bytes) {
  const uint64_t part = kUnit << bits_of_part(max_alloc_bytes);
  return part <= kLargestLeaf ? 0 : W_LEAF_BUFFERS * (part - kLargestLeaf);
}

}  // namespace wale
