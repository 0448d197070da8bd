#pragma once
#include <condition_variable>
#include <filesystem>
#include <functional>
#include <future>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "host/device.h"
#include "host/kernel_note.h"
#include "host/stages.h"

namespace wale {

/// Compiles programs before they are needed, while the host still knits. Whoever asks for one of them with
/// build_program() waits for it instead of compiling it again.
///
/// PoCL makes machine code only when a kernel is launched, and one kernel of a process at a time. Its devices are
/// therefore served by child processes, which build each program and launch its kernels once with zeros for arguments:
/// that asks every kernel of Wale for nothing, and leaves its machine code in PoCL's cache. Once they have compiled
/// everything they leave a note there, and no child is made where it is found.
class Rehearsal {
 public:
  /// What will be compiled for a device.
  struct Plan {
    std::vector<Stage> stages;
    std::string options;
    std::filesystem::path kernel_dir;
  };
  using PlanOf = std::function<Plan(const DeviceTraits&)>;

  /// `devices` as device_numbers() reads it. Forks, and gains by it, only before the process's first call of OpenCL; must
  /// come before its first thread. What fails is left to whoever needs the program.
  Rehearsal(const std::string& devices, PlanOf plan);
  /// Builds in the devices' own contexts, on threads, what the children have compiled, or what other drivers compile.
  void begin(const std::vector<Device>& devices);
  /// True where a note said that everything is compiled already.
  bool cached() const { return cached_; }
  /// Waits until the children have compiled everything, or have failed.
  void finish();
  /// Drops what has not begun. Children are killed.
  ~Rehearsal();
  Rehearsal(const Rehearsal&) = delete;
  Rehearsal& operator=(const Rehearsal&) = delete;

  struct Part;

 private:
  struct Shared;
  void fork_children(const std::string& devices);
  [[noreturn]] void child(const std::string& devices, int report);
  void read_reports();
  void build_next();

  PlanOf plan_;
  std::optional<KernelNote> note_;  ///< to be left
  bool cached_ = false;
  Shared* shared_ = nullptr;  ///< memory that the children see too
  std::vector<int> children_;
  int reports_ = -1;

  std::mutex mutex_;
  std::condition_variable reported_;
  std::vector<Part> parts_;
  std::vector<bool> compiled_;  ///< by a child
  size_t next_ = 0;
  bool dropped_ = false;  ///< nobody waits any more
  bool ended_ = true;     ///< no child compiles
  std::vector<std::thread> threads_;
};

}  // namespace wale
