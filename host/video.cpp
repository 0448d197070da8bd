#include "host/video.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <string>
#include <string_view>

#include "geom/error.h"
#include "host/atomic_file.h"

extern char** environ;

namespace wale {
namespace {

namespace fs = std::filesystem;

// The program's path, or nothing.
fs::path find_program(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::string folders = path ? path : "/usr/bin";
  for (size_t from = 0; from <= folders.size();) {
    const size_t end = std::min(folders.find(':', from), folders.size());
    const fs::path file = fs::path(folders.substr(from, end - from)) / name;
    if (::access(file.c_str(), X_OK) == 0 && fs::is_regular_file(file)) return file;
    from = end + 1;
  }
  return {};
}

class Child {
 public:
  // What it complains of goes to `complaints`. Bytes reach it through a socket, which unlike a pipe tells of its end by
  // an error and not by a signal.
  Child(const std::vector<std::string>& words, const fs::path& complaints) {
    int ends[2];
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) bug("video: no socket");
    to_ = ends[0];
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], 0);
    posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&actions, 2, complaints.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    const int failed = ::posix_spawn(&pid_, words[0].c_str(), &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    ::close(ends[1]);
    if (failed) user_error("{}: cannot be started", words[0]);
  }
  ~Child() {
    if (to_ >= 0) ::close(to_);
    if (pid_ > 0) ::waitpid(pid_, nullptr, 0);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  // False when it no longer listens.
  bool send(const std::vector<unsigned char>& bytes) {
    for (size_t at = 0; at < bytes.size();) {
      const ssize_t sent = ::send(to_, bytes.data() + at, bytes.size() - at, MSG_NOSIGNAL);
      if (sent < 0 && errno == EINTR) continue;
      if (sent <= 0) return false;
      at += size_t(sent);
    }
    return true;
  }

  // True when it ended well.
  bool finish() {
    ::close(to_);
    to_ = -1;
    int status = -1;
    while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
    }
    pid_ = -1;
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
  }

 private:
  int to_ = -1;
  pid_t pid_ = -1;
};

std::string last_line(const fs::path& file) {
  std::ifstream in(file);
  std::string line, last = "it gave no reason";
  while (std::getline(in, line))
    if (!line.empty()) last = line;
  return last;
}

}  // namespace

void require_video(const fs::path& file) {
  if (find_program("ffmpeg").empty())
    user_error(
        "{}: videos are made by ffmpeg, which is not installed (apt-get install ffmpeg); render the frames without "
        "--video",
        file.string());
  constexpr std::array<std::string_view, 4> kSuffixes = {".mp4", ".mkv", ".mov", ".webm"};
  if (std::find(kSuffixes.begin(), kSuffixes.end(), file.extension().string()) == kSuffixes.end())
    user_error("{}: videos are written as .mp4, .mkv, .mov or .webm, not \"{}\"", file.string(),
               file.extension().string());
  require_writable_path(file);
}

void write_video(const fs::path& file, double fps, size_t count, const std::function<VideoFrame(size_t)>& next) {
  AtomicFile out(file), complaints(file.string() + ".log");  // never committed
  VideoFrame frame = next(0);
  const int width = frame.width, height = frame.height;
  Child ffmpeg({find_program("ffmpeg").string(),
                "-hide_banner",
                "-loglevel",
                "error",
                "-y",
                "-f",
                "rawvideo",
                "-pix_fmt",
                "rgb24",
                "-s",
                fmt::format("{}x{}", width, height),
                "-r",
                fmt::format("{:g}", fps),
                "-i",
                "-",
                "-vf",
                "pad=ceil(iw/2)*2:ceil(ih/2)*2",
                "-pix_fmt",
                "yuv420p",
                out.temporary().string()},
               complaints.temporary());
  for (size_t k = 0; k < count; ++k) {
    if (k > 0) frame = next(k);
    if (frame.width != width || frame.height != height)
      user_error("{}: frame {} of the video has {} x {} pixels, the first {} x {}", file.string(), k, frame.width,
                 frame.height, width, height);
    if (!ffmpeg.send(frame.rgb)) break;
  }
  if (!ffmpeg.finish()) user_error("{}: ffmpeg failed: {}", file.string(), last_line(complaints.temporary()));
  out.commit();
}

}  // namespace wale
