#include "host/rehearsal.h"

#include <algorithm>
#include <array>
#include <exception>
#include <future>

#include "geom/error.h"
#include "host/program.h"

namespace wale {

struct Rehearsal::Part {
  ProgramText text;
  std::vector<std::string> kernels;
  size_t items;
  std::promise<void> done;
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

// In a context of its own, so that PoCL compiles several at once.
void build_and_launch(const Device& device, const ProgramText& text, const std::vector<std::string>& kernels,
                      size_t items) {
  const cl::Context context(device.id());
  const cl::CommandQueue queue(context, device.id());
  cl::Program program(context, text.source);
  program.build({device.id()}, text.options.c_str());
  std::vector<char> nothing(1 << 12, 0);
  const cl::Buffer zeros(context, CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR, nothing.size(), nothing.data());
  for (const auto& name : kernels) {
    cl::Kernel kernel(program, name.c_str());
    set_zeros(kernel, zeros);
    queue.enqueueNDRangeKernel(kernel, cl::NullRange, device.global(items), device.local());
  }
  queue.finish();
}

}  // namespace

Rehearsal::Rehearsal(const Device& device, const std::vector<Stage>& stages, const std::string& options,
                     const std::filesystem::path& kernel_dir)
    : device_(device) {
  if (!device.traits().parallel_builds) return;
  for (const Stage& stage : stages) {
    if (!stage.used) continue;
    Part part{stage.before_rays ? program_text(device, stage.file) : program_text(device, stage.file, options, kernel_dir),
              stage.kernels, stage.before_rays ? Device::kLargeGrid : 1, {}};
    const std::lock_guard lock(device.programs().mutex);
    device.programs().ahead.emplace(part.text.key(), part.done.get_future());
    parts_.push_back(std::move(part));
  }
  const size_t threads = std::clamp<size_t>(std::thread::hardware_concurrency(), 1, parts_.size());
  for (size_t i = 0; i < threads; ++i) threads_.emplace_back([this] { work(); });
}

Rehearsal::~Rehearsal() {
  {
    const std::lock_guard lock(mutex_);
    for (Part& part : parts_) part.done.set_value();
    parts_.clear();
  }
  for (auto& thread : threads_) thread.join();
}

void Rehearsal::work() {
  for (;;) {
    std::unique_lock lock(mutex_);
    if (parts_.empty()) return;
    Part part = std::move(parts_.front());
    parts_.pop_front();
    lock.unlock();
    try {
      if (device_.traits().compiles_at_launch)
        build_and_launch(device_, part.text, part.kernels, part.items);
      else
        build_now(device_, part.text);
    } catch (const std::exception&) {
      // What is wrong is said by whoever needs the program.
    }
    part.done.set_value();
  }
}

}  // namespace wale
