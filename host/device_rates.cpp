#include "host/device_rates.h"

#include <algorithm>
#include <ctime>
#include <vector>

#include "host/program.h"
#include "host/wave_counts.h"
#include "shared/wale_types.h"

namespace wale {
namespace {

constexpr int kLaunches = 7;
constexpr size_t kCopied = size_t(64) << 20;  // bytes; larger than the caches of most devices
constexpr uint32_t kChains = 16;              // W_CHAINS of measure.cl
constexpr double kOperations = 4e8;           // of one launch on a CPU: about 10 ms

double least_seconds(const Device& device, const cl::Kernel& kernel, size_t items) {
  std::vector<double> seconds;
  for (int k = 0; k < kLaunches + 1; ++k) {
    const std::clock_t start = std::clock();
    cl::Event event;
    device.queue().enqueueNDRangeKernel(kernel, cl::NullRange, device.global(items), device.local(), nullptr, &event);
    event.wait();
    if (k == 0) continue;  // only warms up
    // Other programs on the machine take a CPU device's time, not its CPU time.
    seconds.push_back(device.traits().cpu
                          ? double(std::clock() - start) / CLOCKS_PER_SEC / device.traits().compute_units
                          : device_seconds(event));
  }
  return std::max(*std::min_element(seconds.begin(), seconds.end()), 1e-9);  // a floor is what is possible
}

}  // namespace

DeviceRates measure_rates(const Device& device) {
  const DeviceTraits& traits = device.traits();
  const cl::Program program = build_program(device, "measure.cl");
  DeviceRates rates;

  rates.copied_bytes =
      std::min({kCopied * (traits.cpu ? 1 : 8), size_t(traits.max_alloc_bytes / 2), size_t(traits.global_bytes / 16)}) /
      sizeof(w_float4) * sizeof(w_float4);
  const size_t count = rates.copied_bytes / sizeof(w_float4);
  Buffer<w_float4> from(device, count), to(device, count);
  from.fill(device, w_float4{1, 2, 3, 4});
  to.fill(device, w_float4{0, 0, 0, 0});
  cl::Kernel copy(program, "copy");
  copy.setArg(0, from.cl());
  copy.setArg(1, to.cl());
  copy.setArg(2, uint32_t(count));
  // A CPU's work-items follow one another in memory; a GPU's stride over it side by side.
  rates.bytes_per_second = 2 * double(rates.copied_bytes) / least_seconds(device, copy, count);

  const size_t items = traits.cpu ? 4096 : size_t(1) << 20;
  const Buffer<float> out(device, items);
  const double work = kOperations * (traits.cpu ? 1 : 1000);
  const auto rounds = uint32_t(std::max(1.0, work / (2.0 * kChains * traits.lanes * double(items))));
  cl::Kernel multiply_add(program, "multiply_add");
  multiply_add.setArg(0, out.cl());
  multiply_add.setArg(1, rounds);
  rates.operations_per_second =
      2.0 * kChains * traits.lanes * double(items) * rounds / least_seconds(device, multiply_add, items);
  return rates;
}

}  // namespace wale
