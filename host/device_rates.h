#pragma once
#include "host/device.h"

namespace wale {

/// What a device does at best, measured: the floors of its stages.
struct DeviceRates {
  double bytes_per_second = 0;       ///< read and written by a copy of float4
  double operations_per_second = 0;  ///< multiplications and additions of floats, in fused multiply-adds
  size_t copied_bytes = 0;           ///< size of the copied buffer
};

/// Runs a copy and chains of multiply-adds for a fraction of a second; the best of seven launches, by the device's
/// clock, or on a CPU device by CPU time over its compute units.
DeviceRates measure_rates(const Device& device);

}  // namespace wale
