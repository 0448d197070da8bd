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

void write_message() {
  const char* cache = std::getenv("POCL_CACHE_DIR");
  const std::string text =
      one_line(
          fmt::format("wale: the OpenCL driver crashed; a damaged kernel cache does this: remove {} (PoCL) and try "
                      "again, or take another device",
                      cache ? cache : "~/.cache/pocl")) +
      "\n";
  message_size = std::min(text.size(), sizeof(message));
  std::memcpy(message, text.data(), message_size);
}

}  // namespace

DriverCall::DriverCall() {
  static const bool written = (write_message(), true);
  (void)written;
  ++calls;
#ifndef __SANITIZE_ADDRESS__
  // Again and again: LLVM, inside the driver, sets handlers of its own.
  for (const int number : kCrashes) ::signal(number, on_crash);
#endif
}

DriverCall::~DriverCall() { --calls; }

}  // namespace wale
