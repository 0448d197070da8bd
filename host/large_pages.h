#pragma once
#include "host/device.h"

namespace wale {

/// Asks the system for large pages for a buffer that nothing has been written to. Rays read a few lines each anywhere
/// in tens of megabytes: with pages of 4 KiB a tenth of their time goes into finding where these are. A wish, on
/// devices that share the host's memory; where it is not granted, or the buffer is small, nothing changes.
void ask_for_large_pages(const Device& device, const cl::Buffer& buffer);

/// A buffer with the data, in large pages where they can be had.
template <typename T>
Buffer<T> in_large_pages(const Device& device, const std::vector<T>& data) {
  Buffer<T> buffer(device, data.size());
  ask_for_large_pages(device, buffer.cl());
  buffer.write(device, data);
  return buffer;
}

}  // namespace wale
