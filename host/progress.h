#pragma once
#include <chrono>
#include <cstdio>
#include <mutex>
#include <string>

namespace wale {

/// Progress of one long step: a bar that redraws itself on a terminal, plain lines (about one per 10 %) elsewhere. May
/// be updated from any thread.
class Progress {
 public:
  /// Writes to `out` (stderr by default). Nothing is shown when `quiet`.
  explicit Progress(std::string title, bool quiet = false, std::FILE* out = stderr);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `fraction` in [0,1] (clamped); `note` is shown behind it, for example "64 spp".
  void update(double fraction, const std::string& note = "");
  /// Shows 100 % and the time taken; further updates do nothing.
  void finish(const std::string& note = "");

 private:
  void draw(double fraction, const std::string& note, bool last);

  std::mutex mutex_;
  std::string title_;
  std::FILE* out_;
  bool quiet_, terminal_, done_ = false;
  int last_tenth_ = 0;
  std::chrono::steady_clock::time_point start_, last_draw_;
};

/// "0.4 s", "12 s", "3 min 20 s", "2 h 05 min".
std::string duration_text(double seconds);

}  // namespace wale
