// Stands before the OpenCL loader (LD_PRELOAD) and lets a device fail in the middle of its work: FAIL_DEVICE, part of
// its name; FAIL_AFTER, launches in this process that still work there; then clEnqueueNDRangeKernel returns
// CL_OUT_OF_RESOURCES.
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>
#include <dlfcn.h>

#include <atomic>
#include <cstdlib>
#include <cstring>

extern "C" cl_int clEnqueueNDRangeKernel(cl_command_queue queue, cl_kernel kernel, cl_uint dimensions,
                                         const size_t* offset, const size_t* global, const size_t* local, cl_uint count,
                                         const cl_event* wait, cl_event* event) {
  static std::atomic<int> launches{0};
  using Function = decltype(&clEnqueueNDRangeKernel);
  static const Function real = reinterpret_cast<Function>(dlsym(RTLD_NEXT, "clEnqueueNDRangeKernel"));
  const char* which = std::getenv("FAIL_DEVICE");
  const char* after = std::getenv("FAIL_AFTER");
  if (which && after) {
    cl_device_id device = nullptr;
    char name[256] = "";
    clGetCommandQueueInfo(queue, CL_QUEUE_DEVICE, sizeof(device), &device, nullptr);
    clGetDeviceInfo(device, CL_DEVICE_NAME, sizeof(name), name, nullptr);
    if (std::strstr(name, which) && launches++ >= std::atoi(after)) return CL_OUT_OF_RESOURCES;
  }
  return real(queue, kernel, dimensions, offset, global, local, count, wait, event);
}
