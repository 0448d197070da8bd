#pragma once
#include <CL/opencl.hpp>
#include <algorithm>
#include <cstdint>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace wale {

/// How rays go down the tree: `lanes` along vectors of the device's width, `simt` one ray per work-item of a GPU
/// (kernels/geometry/traverse_simt.clh). Both find the same hits.
enum class Traversal { lanes, simt };

/// What a device is and what Wale chooses for it; the one table of device traits.
struct DeviceTraits {
  std::string name, vendor, driver, platform, version;
  bool cpu = true;
  bool fp64 = false;
  uint64_t global_bytes = 0, max_alloc_bytes = 0;
  unsigned compute_units = 1;
  unsigned lanes = 1;  ///< width of explicit vectors: 1, 8 or 16 (W_LANES)
  Traversal traversal = Traversal::lanes;
  uint32_t pool = 1u << 16;         ///< paths in flight
  unsigned local_size = 64;         ///< work-group size of every kernel
  bool compiles_at_launch = false;  ///< machine code is made at a kernel's first launch, not by clBuildProgram
  bool parallel_builds = true;      ///< programs may be compiled on several threads at once
  std::string build_options;        ///< what this driver's compiler needs, then WALE_KERNEL_OPTIONS of the environment
};

/// Programs already built for a device, by source and options: an edit that changes neither compiles nothing.
struct ProgramCache {
  std::mutex mutex;
  std::map<std::string, cl::Program> programs;
  std::map<std::string, std::shared_future<void>> ahead;  ///< what a Rehearsal compiles or has compiled
};

/// What `--device` says, before any driver is loaded: numbers with commas between them; nothing for "all". Throws a
/// user error for anything else and for a device named twice.
std::optional<std::vector<unsigned>> named_devices(const std::string& text);
/// The same as numbers of Device::list(), all of them for "all"; whether there are such devices shows when they open.
std::vector<unsigned> device_numbers(const std::string& text);
/// The same for commands that use one device; throws a user error when more are named.
unsigned one_device_number(const std::string& text);

/// An OpenCL device with its context and one in-order queue. Passed explicitly, never global.
class Device {
 public:
  /// Opens device number `index` of list(). Throws a device error that names the package to install when there is none,
  /// or a user error that lists the valid numbers.
  static Device open(unsigned index = 0);
  static std::vector<DeviceTraits> list();
  /// Whether this process has asked for devices before: drivers' threads do not outlive a fork.
  static bool asked_before();

  const DeviceTraits& traits() const { return traits_; }
  DeviceTraits& traits() { return traits_; }
  const cl::Context& context() const { return context_; }
  const cl::CommandQueue& queue() const { return queue_; }
  const cl::Device& id() const { return device_; }
  unsigned number() const { return number_; }  ///< of list()
  ProgramCache& programs() const { return *programs_; }

  /// Rounds a global size up to a multiple of the work-group size.
  cl::NDRange global(size_t items) const;
  /// The same, at least kLargeGrid: PoCL compiles a kernel once for launches below that size and once for others. A
  /// kernel that is launched in both ways, or nobody knows in which, is compiled once only like this.
  cl::NDRange large_global(size_t items) const { return global(items < kLargeGrid ? kLargeGrid : items); }
  static constexpr size_t kLargeGrid = 65536;
  /// Work-items of a group, of which each takes so many rays or hits: groups hold as many of these, whatever takes
  /// them, so that many cores share a short list.
  cl::NDRange local(size_t taken_at_once = 1) const {
    return cl::NDRange(std::max<size_t>(1, traits_.local_size / taken_at_once));
  }

 private:
  DeviceTraits traits_;
  unsigned number_ = 0;
  cl::Device device_;
  cl::Context context_;
  cl::CommandQueue queue_;
  std::shared_ptr<ProgramCache> programs_ = std::make_shared<ProgramCache>();
};

/// A buffer of T on the device; never empty (at least one element is allocated), so that it can always be an argument.
template <typename T>
class Buffer {
 public:
  Buffer() = default;
  Buffer(const Device& device, size_t count) : count_(count) {
    buffer_ = cl::Buffer(device.context(), CL_MEM_READ_WRITE, bytes());
  }
  Buffer(const Device& device, const std::vector<T>& data) : Buffer(device, data.size()) { write(device, data); }

  void write(const Device& device, const std::vector<T>& data) {
    if (!data.empty()) device.queue().enqueueWriteBuffer(buffer_, CL_TRUE, 0, data.size() * sizeof(T), data.data());
  }
  std::vector<T> read(const Device& device) const {
    std::vector<T> data(count_);
    if (count_) device.queue().enqueueReadBuffer(buffer_, CL_TRUE, 0, count_ * sizeof(T), data.data());
    return data;
  }
  void fill(const Device& device, T value) { device.queue().enqueueFillBuffer(buffer_, value, 0, bytes()); }
  size_t count() const { return count_; }
  size_t bytes() const { return (count_ ? count_ : 1) * sizeof(T); }
  const cl::Buffer& cl() const { return buffer_; }

 private:
  size_t count_ = 0;
  cl::Buffer buffer_;
};

}  // namespace wale
