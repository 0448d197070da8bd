#include "host/device.h"

#include <algorithm>
#include <atomic>
#include <charconv>
#include <cstdlib>
#include <numeric>

#include "geom/error.h"

namespace wale {
namespace {

std::atomic<bool> asked{false};

std::vector<cl::Device> all_devices() {
  asked = true;
  std::vector<cl::Device> devices;
  std::vector<cl::Platform> platforms;
  try {
    cl::Platform::get(&platforms);
  } catch (const cl::Error&) {
    return devices;  // the loader reports "no platform" as an error
  }
  for (const auto& platform : platforms) {
    std::vector<cl::Device> found;
    try {
      platform.getDevices(CL_DEVICE_TYPE_ALL, &found);
    } catch (const cl::Error&) {
      continue;
    }
    devices.insert(devices.end(), found.begin(), found.end());
  }
  return devices;
}

// A GPU hides the latency of memory by rays that wait: more paths than its lanes can hold at once, many times over, so
// that a bounce of few paths still fills it. 2^21 paths are some ten times the lanes that the largest GPUs keep
// resident; smaller devices spend at most an eighth of their memory, and no buffer of 64 bytes a path (the feature
// images') may be larger than the device allows.
uint32_t gpu_pool(uint64_t global_bytes, uint64_t max_alloc_bytes) {
  constexpr uint64_t kPathBytes = 256, kWidestBytes = 64, kMost = 1u << 21, kLeast = 1u << 16;
  return uint32_t(std::clamp(std::min(global_bytes / 8 / kPathBytes, max_alloc_bytes / kWidestBytes), kLeast, kMost));
}

Traversal traversal_of(bool cpu) {
  const char* wanted = std::getenv("WALE_TRAVERSAL");
  if (!wanted || !*wanted) return cpu ? Traversal::lanes : Traversal::simt;
  if (wanted == std::string("lanes")) return Traversal::lanes;
  if (wanted == std::string("simt")) return Traversal::simt;
  user_error("WALE_TRAVERSAL: {}: expected lanes or simt, or nothing for the device's own", wanted);
}

DeviceTraits traits_of(const cl::Device& device) {
  DeviceTraits t;
  t.name = device.getInfo<CL_DEVICE_NAME>();
  t.vendor = device.getInfo<CL_DEVICE_VENDOR>();
  t.driver = device.getInfo<CL_DRIVER_VERSION>();
  t.version = device.getInfo<CL_DEVICE_VERSION>();
  t.platform = cl::Platform(device.getInfo<CL_DEVICE_PLATFORM>()).getInfo<CL_PLATFORM_NAME>();
  t.cpu = device.getInfo<CL_DEVICE_TYPE>() & CL_DEVICE_TYPE_CPU;
  t.fp64 = device.getInfo<CL_DEVICE_EXTENSIONS>().find("cl_khr_fp64") != std::string::npos;
  t.global_bytes = device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>();
  t.max_alloc_bytes = device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>();
  t.compute_units = device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>();
  // Explicit vectors pay on CPUs; GPUs run one ray per work-item in scalar code.
  const unsigned native = device.getInfo<CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT>();
  t.traversal = traversal_of(t.cpu);
  t.lanes = !t.cpu || t.traversal == Traversal::simt ? 1 : native >= 16 ? 16 : native >= 8 ? 8 : 1;
  // One kernel variant of PoCL's for launches of a whole pool and for the shorter ones that follow.
  t.pool = t.cpu ? Device::kLargeGrid - 512 : gpu_pool(t.global_bytes, t.max_alloc_bytes);
  // Whole warps of 32 and wavefronts of 64; no more, since a group holds its place until its longest ray is done.
  t.local_size = std::min<size_t>(64, device.getInfo<CL_DEVICE_MAX_WORK_GROUP_SIZE>());
  // Oclgrind's compiler shares one LLVM context between threads and crashes when two of them build; its interpreter
  // knows no intrinsic that inlining and optimising make (llvm.experimental.noalias.scope.decl, llvm.bitreverse).
  t.compiles_at_launch = t.platform.find("Portable Computing Language") != std::string::npos;
  if (t.platform.find("Oclgrind") != std::string::npos) {
    t.parallel_builds = false;
    t.build_options = " -cl-opt-disable -DW_PORTABLE";
  }
  if (const char* more = std::getenv("WALE_KERNEL_OPTIONS")) {
    // The host sizes its launches by the lanes.
    if (std::string(more).find("W_LANES") != std::string::npos)
      user_error("WALE_KERNEL_OPTIONS: {}: W_LANES is chosen by the scene's integrator.lanes", more);
    t.build_options += std::string(" ") + more;
  }
  return t;
}

std::vector<cl::Device> require_devices() {
  auto devices = all_devices();
  if (devices.empty())
    device_error(
        "OpenCL: no device found; install a CPU device with `apt-get install pocl-opencl-icd`, or your GPU's driver");
  return devices;
}

}  // namespace

bool Device::asked_before() { return asked; }

std::vector<DeviceTraits> Device::list() {
  std::vector<DeviceTraits> traits;
  for (const auto& device : all_devices()) traits.push_back(traits_of(device));
  return traits;
}

std::optional<std::vector<unsigned>> named_devices(const std::string& text) {
  if (text == "all") return {};
  std::vector<unsigned> numbers;
  for (const char *at = text.data(), *end = at + text.size();; ++at) {
    unsigned number = 0;
    const auto [next, error] = std::from_chars(at, end, number);
    if (error != std::errc() || (next != end && *next != ','))
      user_error("--device {}: expected a number, numbers with commas between them, for example 0,1, or all", text);
    if (std::find(numbers.begin(), numbers.end(), number) != numbers.end())
      user_error("--device {}: device {} is named twice", text, number);
    numbers.push_back(number);
    if (next == end) return numbers;
    at = next;
  }
}

std::vector<unsigned> device_numbers(const std::string& text) {
  if (const auto named = named_devices(text)) return *named;
  std::vector<unsigned> numbers(require_devices().size());
  std::iota(numbers.begin(), numbers.end(), 0u);
  return numbers;
}

unsigned one_device_number(const std::string& text) {
  const auto numbers = device_numbers(text);
  if (numbers.size() > 1)
    user_error("--device {}: only a render uses several devices; give one number, for example --device {}", text,
               numbers.front());
  return numbers.front();
}

Device Device::open(unsigned index) {
  const auto devices = require_devices();
  if (index >= devices.size())
    user_error("--device {}: there is no such device; valid: 0 to {} (see `wale devices`)", index, devices.size() - 1);
  Device d;
  d.number_ = index;
  d.device_ = devices[index];
  d.traits_ = traits_of(d.device_);
  d.context_ = cl::Context(d.device_);
  d.queue_ = cl::CommandQueue(d.context_, d.device_, CL_QUEUE_PROFILING_ENABLE);
  return d;
}

cl::NDRange Device::global(size_t items) const {
  const size_t group = traits_.local_size;
  return cl::NDRange(std::max<size_t>(1, (items + group - 1) / group) * group);
}

}  // namespace wale
