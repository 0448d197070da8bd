#include "host/device_fault.h"

#include <fmt/format.h>

namespace wale {
namespace {

struct Named {
  cl_int code;
  const char *name, *help;
};

constexpr const char* kMemory =
    "; the device has too little memory free: use fewer repeats, a smaller film or pool, "
    "or another device (see `wale devices`)";
constexpr Named kCodes[] = {
    {CL_DEVICE_NOT_AVAILABLE, "CL_DEVICE_NOT_AVAILABLE", "; something else holds the device"},
    {CL_COMPILER_NOT_AVAILABLE, "CL_COMPILER_NOT_AVAILABLE", "; its driver has no compiler"},
    {CL_MEM_OBJECT_ALLOCATION_FAILURE, "CL_MEM_OBJECT_ALLOCATION_FAILURE", kMemory},
    {CL_OUT_OF_RESOURCES, "CL_OUT_OF_RESOURCES", "; a kernel failed, or the device has too little memory free"},
    {CL_OUT_OF_HOST_MEMORY, "CL_OUT_OF_HOST_MEMORY", kMemory},
    {CL_INVALID_BUFFER_SIZE, "CL_INVALID_BUFFER_SIZE", kMemory},
    {CL_INVALID_KERNEL_NAME, "CL_INVALID_KERNEL_NAME",
     "; the driver's kernel cache may be damaged: remove it (PoCL: ~/.cache/pocl, or POCL_CACHE_DIR)"},
    {CL_INVALID_BUILD_OPTIONS, "CL_INVALID_BUILD_OPTIONS", ""},
    {CL_INVALID_KERNEL_ARGS, "CL_INVALID_KERNEL_ARGS", ""},
    {CL_INVALID_WORK_GROUP_SIZE, "CL_INVALID_WORK_GROUP_SIZE", ""},
};

}  // namespace

std::string opencl_fault(const cl::Error& error) {
  for (const Named& code : kCodes)
    if (code.code == error.err())
      return fmt::format("OpenCL: {} failed: {} ({}){}", error.what(), code.name, code.code, code.help);
  return fmt::format("OpenCL: {} failed with error {}", error.what(), error.err());
}

}  // namespace wale
