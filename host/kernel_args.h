#pragma once
#include "host/device.h"

namespace wale {

/// Sets the arguments of a kernel from `first` on.
template <typename... Args>
void set_args(cl::Kernel& kernel, cl_uint first, const Args&... args) {
  cl_uint index = first;
  (kernel.setArg(index++, args), ...);
}

}  // namespace wale
