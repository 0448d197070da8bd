#include "host/atomic_file.h"

#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <charconv>
#include <fstream>
#include <map>
#include <mutex>
#include <optional>
#include <string_view>

#include "geom/byte_source.h"
#include "geom/error.h"

namespace wale {
namespace fs = std::filesystem;

namespace {

// Where process numbers mean something: this machine and its processes, as folders are shared between machines and
// containers.
const std::string& process_space() {
  static const std::string name = [] {
    char host[256] = "";
    ::gethostname(host, sizeof(host) - 1);
    std::error_code failed;
    const fs::path space = fs::read_symlink("/proc/self/ns/pid", failed);
    // Hosts may share a name, and the number of a process space; what a boot is called is each one's own.
    std::string boot;
    std::ifstream("/proc/sys/kernel/random/boot_id") >> boot;
    return fmt::format("{:08x}", hash_bytes(std::string(host) + "/" + boot + "/" + space.string()) >> 32);
  }();
  return name;
}

// ".f.SPACE.PROCESS.COUNT.tmp.exr" of f.exr: two programs, or two threads of one, may write the same name at once.
std::string temporary_name(const fs::path& file, unsigned count) {
  return fmt::format(".{}.{}.{}.{}.tmp{}", file.stem().string(), process_space(), ::getpid(), count,
                     file.extension().string());
}

// A temporary file of this machine: what it was to become, and who writes it.
struct Temporary {
  std::string name;
  pid_t process = 0;
};
std::optional<Temporary> read_temporary_name(const std::string& name) {
  const std::string middle = "." + process_space() + ".";
  const size_t at = name.rfind(middle);
  if (name.empty() || name[0] != '.' || at == std::string::npos || at < 1) return {};
  const char *from = name.data() + at + middle.size(), *to = name.data() + name.size();
  Temporary out;
  unsigned count = 0;
  const auto dot = std::from_chars(from, to, out.process);
  if (dot.ec != std::errc() || dot.ptr == to || *dot.ptr != '.' || out.process <= 0) return {};
  const auto stop = std::from_chars(dot.ptr + 1, to, count);
  const std::string_view end(stop.ptr, size_t(to - stop.ptr));
  if (stop.ec != std::errc() || !end.starts_with(".tmp")) return {};
  out.name = name.substr(1, at - 1) + std::string(end.substr(4));
  return out;
}

bool is_alive(pid_t process) { return ::kill(process, 0) == 0 || errno != ESRCH; }

// What writers that were killed have left. A folder is looked through once a run: it may hold thousands of frames.
class LeftBehind {
 public:
  void remove(const fs::path& folder, const fs::path& file) {
    const std::lock_guard lock(mutex_);
    std::error_code ignored;
    const fs::path full = fs::absolute(folder, ignored);  // fails where the working folder has gone
    const auto [known, is_new] = folders_.try_emplace((ignored ? folder : full).lexically_normal());
    if (is_new) known->second = look_through(folder);
    const auto [first, last] = known->second.equal_range(file.filename().string());
    for (auto at = first; at != last; ++at)
      if (!is_alive(at->second.first)) fs::remove(at->second.second, ignored);
    known->second.erase(first, last);
  }

 private:
  using Files = std::multimap<std::string, std::pair<pid_t, fs::path>>;  // by what they were to become

  static Files look_through(const fs::path& folder) {
    Files out;
    std::error_code failed;
    for (fs::directory_iterator at(folder, failed), last; !failed && at != last; at.increment(failed))
      if (const auto temporary = read_temporary_name(at->path().filename().string()))
        out.emplace(temporary->name, std::pair(temporary->process, at->path()));
    return out;
  }

  std::mutex mutex_;
  std::map<fs::path, Files> folders_;
};

}  // namespace

AtomicFile::AtomicFile(const fs::path& file) : file_(file) {
  static std::atomic<unsigned> counter{0};
  std::error_code error;
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  if (file.filename().empty() || fs::is_directory(file, error))
    user_error("{}: this is a folder; give the name of a file in it", file.string());
  if (!fs::is_directory(folder, error))
    user_error("{}: the folder {} does not exist; make it first", file.string(), folder.string());
  static LeftBehind left_behind;
  left_behind.remove(folder, file);
  temporary_ = folder / temporary_name(file, counter++);
  if (!std::ofstream(temporary_)) user_error("{}: the folder {} cannot be written", file.string(), folder.string());
}

AtomicFile::~AtomicFile() {
  std::error_code ignored;
  if (!committed_) fs::remove(temporary_, ignored);
}

void AtomicFile::commit() {
  std::error_code error;
  fs::rename(temporary_, file_, error);
  if (error) user_error("{}: cannot be written: {}", file_.string(), error.message());
  committed_ = true;
}

bool AtomicFile::commit_if_new() {
  std::error_code error;
  fs::create_hard_link(temporary_, file_, error);  // unlike a rename it takes no other file's place
  if (error == std::errc::file_exists) return false;
  if (error) user_error("{}: cannot be written: {}", file_.string(), error.message());
  return true;
}

static void fill(const AtomicFile& out, const fs::path& file, const std::string& text) {
  std::ofstream stream(out.temporary(), std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) user_error("{}: cannot be written; is the disk full?", file.string());
}

void write_text_file(const fs::path& file, const std::string& text) {
  AtomicFile out(file);
  fill(out, file, text);
  out.commit();
}

bool write_new_text_file(const fs::path& file, const std::string& text) {
  AtomicFile out(file);
  fill(out, file, text);
  return out.commit_if_new();
}

void require_writable_path(const fs::path& file) { AtomicFile probe(file); }

}  // namespace wale
