// Stands before the C library (LD_PRELOAD) and kills the process when a file is about to get the name that ends with
// KILL_AT: all of it is written, under its temporary name.
#include <dlfcn.h>
#include <signal.h>
#include <unistd.h>

#include <cstdlib>
#include <string_view>

extern "C" int rename(const char* from, const char* to) noexcept {
  using Function = int (*)(const char*, const char*);
  static const Function real = reinterpret_cast<Function>(dlsym(RTLD_NEXT, "rename"));
  const char* end = std::getenv("KILL_AT");
  if (end && std::string_view(to).ends_with(end)) kill(getpid(), SIGKILL);
  return real(from, to);
}
