#include "host/driver_crash.h"

#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <cstring>
#include <string>

#include "geom/error.h"

namespace wale {
namespace {

constexpr int kCrashes[] = {SIGABRT, SIGBUS, SIGSEGV};
std::atomic<int> calls{0};
// Made beforehand: a handler may only write.
char message[1024];
size_t message_size = 0;

void on_crash(int number) {
  if (calls > 0) {
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, message, message_size);
    ::_exit(int(Fault::device));
  }
  ::signal(number, SIG_DFL);
  ::raise(number);
}

void catch_crashes() {
  const char* cache = std::getenv("POCL_CACHE_DIR");
  const std::string text = one_line(fmt::format(
      "wale: the OpenCL driver crashed; a damaged kernel cache does this: remove {} (PoCL) and try again, or take "
      "another device", cache ? cache : "~/.cache/pocl")) + "\n";
  message_size = std::min(text.size(), sizeof(message));
  std::memcpy(message, text.data(), message_size);
  for (const int number : kCrashes) {
    struct sigaction now{};
    // Sanitizers and debuggers have handlers of their own.
    if (::sigaction(number, nullptr, &now) != 0 || now.sa_handler != SIG_DFL) continue;
    struct sigaction ours{};
    ours.sa_handler = on_crash;
    ::sigaction(number, &ours, nullptr);
  }
}

}  // namespace

DriverCall::DriverCall() {
  static const bool caught = (catch_crashes(), true);
  (void)caught;
  ++calls;
}

DriverCall::~DriverCall() { --calls; }

}  // namespace wale
