#pragma once
#include <deque>
#include <filesystem>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "host/device.h"
#include "host/stages.h"

namespace wale {

/// Compiles programs on threads of its own before they are needed, while the host still knits. Whoever asks for one of
/// them with build_program() waits for it here instead of compiling it again.
///
/// PoCL makes machine code only when a kernel is launched, for each form of launch, and one kernel of a context at a
/// time. There each program is built in a context of its own and its kernels are launched once with zeros for
/// arguments, which asks every kernel of Wale for nothing; the real context then finds them in PoCL's cache.
class Rehearsal {
 public:
  Rehearsal(const Device& device, const std::vector<Stage>& stages, const std::string& options,
            const std::filesystem::path& kernel_dir = {});
  /// Drops what has not begun and waits for what has.
  ~Rehearsal();
  Rehearsal(const Rehearsal&) = delete;
  Rehearsal& operator=(const Rehearsal&) = delete;

 private:
  struct Part;
  void work();

  const Device& device_;
  std::mutex mutex_;
  std::deque<Part> parts_;
  std::vector<std::thread> threads_;
};

}  // namespace wale
