#include "host/large_pages.h"

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>

namespace wale {
namespace {

constexpr size_t kWorthIt = size_t(4) << 20;  // bytes: two large pages

}  // namespace

void ask_for_large_pages(const Device& device, const cl::Buffer& buffer) {
  const size_t bytes = buffer.getInfo<CL_MEM_SIZE>();
  if (!device.traits().cpu || bytes < kWorthIt) return;
#ifdef MADV_HUGEPAGE
  void* const memory = device.queue().enqueueMapBuffer(buffer, CL_TRUE, CL_MAP_WRITE_INVALIDATE_REGION, 0, bytes);
  const uintptr_t page = uintptr_t(sysconf(_SC_PAGESIZE)), begin = uintptr_t(memory);
  const uintptr_t first = (begin + page - 1) / page * page, last = (begin + bytes) / page * page;
  madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE);
  device.queue().enqueueUnmapMemObject(buffer, memory);
  device.queue().finish();
#endif
}

}  // namespace wale
