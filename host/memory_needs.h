#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "host/device.h"
#include "host/features.h"

namespace wale {

/// Memory that one part of a render takes on a device.
struct MemoryNeed {
  std::string name;
  uint64_t bytes = 0;
  uint64_t largest = 0;  ///< bytes of its largest buffer, of those that are not split where one may not hold them
  std::string instead;  ///< the nearest choice that takes less, in words
};

/// What a render of this world takes on a device, largest first; the tree's part is an estimate.
std::vector<MemoryNeed> memory_needs(const World& world, const Features& features, uint32_t pool,
                                     const DeviceTraits& traits);

/// Throws a user error with the figures when the device has less, or when one buffer may not be as large as needed.
void require_memory(const Device& device, const std::vector<MemoryNeed>& needs);

}  // namespace wale
