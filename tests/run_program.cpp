#include "tests/run_program.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <regex>
#include <sstream>
#include <thread>

#include "tests/temporary_folder.h"

extern char** environ;

namespace wale::test {

Process::Process(const std::filesystem::path& folder, const std::vector<std::string>& args,
                 const std::vector<std::string>& environment)
    : out_(folder / "stdout.txt"), err_(folder / "stderr.txt"), start_(std::chrono::steady_clock::now()) {
  std::vector<std::string> words{WALE_PROGRAM}, variables(environment);
  words.insert(words.end(), args.begin(), args.end());
  for (char** e = environ; *e; ++e) {
    const std::string name = std::string(*e).substr(0, std::string(*e).find('=') + 1);
    bool replaced = false;
    for (const auto& v : environment) replaced |= v.starts_with(name);
    if (!replaced) variables.push_back(*e);
  }
  std::vector<char*> argv, envp;
  for (auto& w : words) argv.push_back(w.data());
  for (auto& v : variables) envp.push_back(v.data());
  argv.push_back(nullptr);
  envp.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out_.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0600);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, err_.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0600);
  const int failed = posix_spawn(&pid_, WALE_PROGRAM, &actions, nullptr, argv.data(), envp.data());
  posix_spawn_file_actions_destroy(&actions);
  if (failed) {
    ADD_FAILURE() << WALE_PROGRAM << ": cannot be started";
    done_ = true;
  }
}

Process::~Process() {
  if (!done_) wait(0);
}

std::string Process::out() const { return file_text(out_); }
std::string Process::err() const { return file_text(err_); }

void Process::signal(int number) const {
  if (!done_) ::kill(pid_, number);
}

double Process::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

bool Process::ended() {
  int status = 0;
  if (!done_ && ::waitpid(pid_, &status, WNOHANG) == pid_) {
    done_ = true;
    status_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  return done_;
}

bool Process::wait_for(const std::string& text, double seconds) {
  const double until = this->seconds() + seconds;
  while (true) {
    const bool over = ended() || this->seconds() > until;  // looked at before the text: its last words count
    if (err().find(text) != std::string::npos) return true;
    if (over) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

int Process::wait(double seconds) {
  const double until = this->seconds() + seconds;
  while (!ended()) {
    if (this->seconds() > until) {
      ::kill(pid_, SIGKILL);
      ::waitpid(pid_, nullptr, 0);
      done_ = true;
      status_ = -1;
      break;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return status_;
}

std::vector<std::string> Outcome::complaints() const {
  static const std::regex progress(
      "(knit|render|check|frames|video) +[0-9]+ %.*|[0-9]+ (to [0-9]+ )?samples per pixel.* in .*|error of a tile: .*");
  std::vector<std::string> lines;
  std::istringstream in(err);
  for (std::string line; std::getline(in, line);)
    if (!std::regex_match(line, progress)) lines.push_back(line);
  return lines;
}

Outcome run_wale(const std::vector<std::string>& args, const std::vector<std::string>& environment, double seconds) {
  TemporaryFolder folder;
  Process process(folder.path(), args, environment);
  Outcome run;
  run.status = process.wait(seconds);
  run.seconds = process.seconds();
  run.out = process.out();
  run.err = process.err();
  return run;
}

}  // namespace wale::test
