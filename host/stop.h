#pragma once

namespace wale {

/// Makes Ctrl-C and SIGTERM ask for a stop instead of ending the program: what has been rendered is kept.
void catch_stop_signals();
bool stop_requested();

}  // namespace wale
