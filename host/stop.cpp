#include "host/stop.h"

#include <csignal>

namespace wale {
namespace {
volatile std::sig_atomic_t requested = 0;
// A second signal ends the program at once: the default action is back.
void on_signal(int number) {
  requested = 1;
  std::signal(number, SIG_DFL);
}
}  // namespace

void catch_stop_signals() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
}

bool stop_requested() { return requested != 0; }

}  // namespace wale
