#include "host/rehearsal.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdlib>
#include <exception>
#include <tuple>

#include "geom/error.h"
#include "host/program.h"

namespace wale {

struct Rehearsal::Part {
  Device device;
  ProgramText text;
  std::vector<std::string> kernels;
  size_t items = 1, taken_at_once = 1;
  bool can_wait = false;
  std::promise<void> done;
};

struct Rehearsal::Shared {
  std::atomic<uint32_t> next{0};  ///< part that no child has begun
};

namespace {

// Every argument zero: a buffer of zeros, or a zero of the parameter's size. PoCL takes any size for a struct, so that
// the largest goes first.
void set_zeros(cl::Kernel& kernel, const cl::Buffer& zeros) {
  static constexpr std::array<char, 128> kNothing{};
  for (cl_uint i = 0; i < kernel.getInfo<CL_KERNEL_NUM_ARGS>(); ++i) {
    if (kernel.getArgInfo<CL_KERNEL_ARG_ADDRESS_QUALIFIER>(i) == CL_KERNEL_ARG_ADDRESS_GLOBAL) {
      kernel.setArg(i, zeros);
      continue;
    }
    cl_int error = CL_INVALID_ARG_SIZE;
    for (size_t size = kNothing.size(); size > 0 && error != CL_SUCCESS; size -= 4)
      error = clSetKernelArg(kernel(), i, size, kNothing.data());
    if (error != CL_SUCCESS) throw cl::Error(error, "clSetKernelArg");
  }
}

void build_and_launch(const Device& device, const ProgramText& text, const std::vector<std::string>& kernels,
                      size_t items, size_t taken_at_once) {
  const cl::Program program = build_now(device, text);
  const Buffer<uint32_t> zeros(device, std::vector<uint32_t>(1024, 0));
  for (const auto& name : kernels) {
    cl::Kernel kernel(program, name.c_str());
    set_zeros(kernel, zeros.cl());
    device.queue().enqueueNDRangeKernel(kernel, cl::NullRange, device.global(items), device.local(taken_at_once));
  }
  device.queue().finish();
}

}  // namespace

static ProgramText text_of(const DeviceTraits& traits, const StageProgram& program, const Rehearsal::Plan& plan) {
  return program.before_rays ? program_text(traits, program.file)
                             : program_text(traits, program.file, plan.options, plan.kernel_dir);
}

// Parts of all devices in one order, the same in every process: first what is needed first, then the
// longest, what can wait last.
static std::vector<Rehearsal::Part> parts_of(const std::vector<Device>& devices, const Rehearsal::PlanOf& plan_of) {
  std::vector<Rehearsal::Part> parts;
  for (const Device& device : devices) {
    const Rehearsal::Plan plan = plan_of(device.traits());
    const size_t first = parts.size();
    if (!device.traits().parallel_builds) continue;
    for (const StageProgram& program : programs_of(plan.stages, device.traits().compiles_at_launch)) {
      Rehearsal::Part& part = parts.emplace_back();
      part.device = device;
      part.text = text_of(device.traits(), program, plan);
      part.kernels = program.kernels;
      part.items = program.before_rays ? Device::kLargeGrid : 1;
      part.can_wait = program.can_wait;
      part.taken_at_once = program.taken_at_once;
    }
    std::stable_sort(parts.begin() + std::ptrdiff_t(first), parts.end(), [](const auto& a, const auto& b) {
      return std::tuple(b.items, a.can_wait, b.text.source.size()) <
             std::tuple(a.items, b.can_wait, a.text.source.size());
    });
  }
  return parts;
}

// What decides which programs are compiled, as far as it is known before a device is: `some_device` stands for those
// that the names mean.
static std::string what_is_compiled(const std::string& devices, const Rehearsal::PlanOf& plan_of) {
  DeviceTraits some_device;
  some_device.lanes = 16;
  some_device.compiles_at_launch = true;
  std::string all = devices;
  for (const char* name : {"POCL_DEVICES", "WALE_KERNEL_OPTIONS", "WALE_TRAVERSAL"})
    if (const char* value = std::getenv(name)) all += fmt::format("\n{}={}", name, value);
  const Rehearsal::Plan plan = plan_of(some_device);
  for (const StageProgram& program : programs_of(plan.stages, some_device.compiles_at_launch))
    all += '\n' + text_of(some_device, program, plan).key();
  return all;
}

Rehearsal::Rehearsal(const std::string& devices, PlanOf plan) : plan_(std::move(plan)) {
  if (!KernelNote::cache_is_used()) return;  // what children compile would be lost
  note_ = KernelNote(what_is_compiled(devices, plan_));
  cached_ = note_->found();
  // A child of a process whose driver runs already would wait for that driver's threads for ever.
  if (!cached_ && !Device::asked_before()) fork_children(devices);
}

void Rehearsal::fork_children(const std::string& devices) {
  void* memory = mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  int ends[2];
  if (memory == MAP_FAILED || pipe2(ends, O_CLOEXEC) != 0) return;
  shared_ = new (memory) Shared;
  reports_ = ends[0];
  const unsigned count = std::clamp(std::thread::hardware_concurrency(), 1u, 8u);
  for (unsigned i = 0; i < count; ++i) {
    const pid_t pid = fork();
    if (pid == 0) child(devices, ends[1]);
    if (pid > 0) children_.push_back(pid);
  }
  close(ends[1]);
}

void Rehearsal::child(const std::string& devices, int report) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  const int nowhere = open("/dev/null", O_WRONLY);
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
  try {
    const std::vector<DeviceTraits> traits = Device::list();
    std::vector<Device> open_devices;
    for (const unsigned number : device_numbers(devices)) {
      if (!traits.at(number).compiles_at_launch) _exit(0);  // its parts would have other numbers here
      open_devices.push_back(Device::open(number));
    }
    const std::vector<Part> parts = parts_of(open_devices, plan_);
    for (uint32_t i; (i = shared_->next++) < parts.size();) {
      build_and_launch(parts[i].device, parts[i].text, parts[i].kernels, parts[i].items, parts[i].taken_at_once);
      if (write(report, &i, sizeof(i)) != sizeof(i)) _exit(0);
    }
  } catch (const std::exception&) {
    // The parent meets the same fault and says so.
  }
  _exit(0);
}

void Rehearsal::begin(const std::vector<Device>& devices) {
  parts_ = parts_of(devices, plan_);
  compiled_.assign(parts_.size(), children_.empty());
  for (size_t i = 0; i < parts_.size(); ++i) {
    if (!parts_[i].device.traits().compiles_at_launch) compiled_[i] = true;
    const std::lock_guard lock(parts_[i].device.programs().mutex);
    parts_[i].device.programs().ahead.emplace(parts_[i].text.key(), parts_[i].done.get_future());
  }
  ended_ = reports_ < 0;
  if (reports_ >= 0) threads_.emplace_back([this] { read_reports(); });
  const size_t builders = std::min<size_t>(std::max(1u, std::thread::hardware_concurrency()), parts_.size());
  for (size_t i = 0; i < builders; ++i) threads_.emplace_back([this] { build_next(); });
}

void Rehearsal::read_reports() {
  uint32_t part = 0;
  size_t count = 0;
  while (read(reports_, &part, sizeof(part)) == sizeof(part)) {
    const std::lock_guard lock(mutex_);
    if (part < compiled_.size()) compiled_[part] = true;
    if (++count == parts_.size()) note_->leave();
    reported_.notify_all();
  }
  const std::lock_guard lock(mutex_);  // the children are gone: the rest is compiled here
  for (const int child : children_) waitpid(child, nullptr, 0);
  children_.clear();
  compiled_.assign(compiled_.size(), true);
  ended_ = true;
  reported_.notify_all();
}

void Rehearsal::finish() {
  std::unique_lock lock(mutex_);
  reported_.wait(lock, [&] { return ended_; });
}

void Rehearsal::build_next() {
  for (;;) {
    std::unique_lock lock(mutex_);
    if (next_ >= parts_.size()) return;
    const size_t i = next_++;
    reported_.wait(lock, [&] { return compiled_[i] || dropped_; });
    const bool dropped = dropped_;
    lock.unlock();
    try {
      if (!dropped) build_now(parts_[i].device, parts_[i].text);
    } catch (const std::exception&) {
      // Whoever needs the program meets the same fault and says so.
    }
    parts_[i].done.set_value();
  }
}

Rehearsal::~Rehearsal() {
  size_t dropped;
  {
    const std::lock_guard lock(mutex_);
    dropped = next_;
    next_ = parts_.size();
    dropped_ = true;
    reported_.notify_all();
  }
  for (size_t i = dropped; i < parts_.size(); ++i) parts_[i].done.set_value();
  {
    const std::lock_guard lock(mutex_);
    for (const int child : children_) kill(child, SIGKILL);
    if (reports_ < 0 || threads_.empty())
      for (const int child : children_) waitpid(child, nullptr, 0);
  }
  for (auto& thread : threads_) thread.join();  // the pipe has ended
  if (reports_ >= 0) close(reports_);
  if (shared_) munmap(shared_, sizeof(Shared));
}

}  // namespace wale
