#pragma once
#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

namespace wale::test {

/// The real program as a process of its own.
class Process {
 public:
  /// `folder` takes what the program prints; `environment` holds NAME=value, added to this process's own.
  Process(const std::filesystem::path& folder, const std::vector<std::string>& args,
          const std::vector<std::string>& environment = {});
  ~Process();  ///< kills it when nobody waited
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  std::string out() const;
  std::string err() const;
  void signal(int number) const;
  /// Waits until stderr holds `text`; false when the program ended or `seconds` went by first.
  bool wait_for(const std::string& text, double seconds);
  /// Exit status, 128 + signal when it died of one, -1 when it had to be killed after `seconds`.
  int wait(double seconds);
  double seconds() const;  ///< since the start
  int pid() const { return pid_; }

 private:
  bool ended();
  std::filesystem::path out_, err_;
  int pid_ = -1, status_ = -1;
  bool done_ = false;
  std::chrono::steady_clock::time_point start_;
};

/// What a finished run left behind.
struct Outcome {
  int status = -1;
  std::string out, err;
  double seconds = 0;
  /// Lines of stderr that are neither progress nor the summary of a render.
  std::vector<std::string> complaints() const;
};

Outcome run_wale(const std::vector<std::string>& args, const std::vector<std::string>& environment = {},
                 double seconds = 120);

}  // namespace wale::test
