#pragma once
// Embree as both comparisons open it: two threads, and every byte that it takes counted.
#include <embree3/rtcore.h>

#include <atomic>
#include <cstdint>

namespace wale::bench {

/// `bytes` follows what Embree holds; it must outlive the device.
inline RTCDevice open_embree(std::atomic<int64_t>& bytes) {
  const RTCDevice device = rtcNewDevice("threads=2,frequency_level=simd512");
  rtcSetDeviceMemoryMonitorFunction(
      device,
      [](void* count, ssize_t change, bool) {
        *static_cast<std::atomic<int64_t>*>(count) += change;
        return true;
      },
      &bytes);
  return device;
}

}  // namespace wale::bench
