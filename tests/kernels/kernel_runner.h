#pragma once
#include <string>
#include <vector>

#include "host/program.h"

namespace wale::test {

/// Runs test kernels whose real type is w_real: the same source in float and, on devices with fp64, in double.
/// Kernel arguments are buffers and plain values in order; the last two are the output (w_real) and the item count.
class KernelRunner {
 public:
  KernelRunner(const std::string& source, bool twice, const std::string& variant = "")
      : device_(Device::open()),
        twice_(twice),
        program_(build_program_text(device_, source, (twice ? "-DW_DOUBLE -DW_LANES=1 " : "-DW_LANES=1 ") + variant)) {}

  const Device& device() const { return device_; }

  template <typename T>
  Buffer<T> upload(const std::vector<T>& data) const {
    return Buffer<T>(device_, data);
  }

  /// Returns items * outputs values as double.
  template <typename... Args>
  std::vector<double> run(const char* name, size_t items, size_t outputs, const Args&... args) const {
    return twice_ ? run_as<double>(name, items, outputs, args...) : run_as<float>(name, items, outputs, args...);
  }

 private:
  template <typename T>
  static void set(cl::Kernel& kernel, cl_uint index, const Buffer<T>& buffer) {
    kernel.setArg(index, buffer.cl());
  }
  template <typename T>
  static void set(cl::Kernel& kernel, cl_uint index, const T& value) {
    kernel.setArg(index, value);
  }
  template <typename Real, typename... Args>
  std::vector<double> run_as(const char* name, size_t items, size_t outputs, const Args&... args) const {
    cl::Kernel kernel(program_, name);
    cl_uint index = 0;
    (set(kernel, index++, args), ...);
    Buffer<Real> out(device_, items * outputs);
    kernel.setArg(index++, out.cl());
    kernel.setArg(index++, cl_uint(items));
    device_.queue().enqueueNDRangeKernel(kernel, cl::NullRange, device_.global(items), device_.local());
    const std::vector<Real> values = out.read(device_);
    return {values.begin(), values.end()};
  }

  Device device_;
  bool twice_;
  cl::Program program_;
};

}  // namespace wale::test
