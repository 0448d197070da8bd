#pragma once
#include <CL/opencl.hpp>
#include <string>

namespace wale {

/// What failed in a call of OpenCL, and what helps: "clEnqueueNDRangeKernel failed: CL_OUT_OF_RESOURCES (-5); ...".
std::string opencl_fault(const cl::Error& error);

}  // namespace wale
