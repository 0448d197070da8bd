#include "host/atomic_file.h"

#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <charconv>
#include <fstream>

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
std::string temporary_begin(const fs::path& file) {
  return fmt::format(".{}.{}.", file.stem().string(), process_space());
}
std::string temporary_end(const fs::path& file) { return ".tmp" + file.extension().string(); }

bool is_alive(pid_t process) { return ::kill(process, 0) == 0 || errno != ESRCH; }

void remove_left_behind(const fs::path& folder, const fs::path& file) {
  const std::string begin = temporary_begin(file), end = temporary_end(file);
  std::error_code failed, ignored;
  for (fs::directory_iterator at(folder, failed), last; !failed && at != last; at.increment(failed)) {
    const std::string name = at->path().filename().string();
    if (name.size() <= begin.size() + end.size() || !name.starts_with(begin) || !name.ends_with(end)) continue;
    const char *from = name.data() + begin.size(), *to = name.data() + name.size() - end.size();
    pid_t process = 0;
    unsigned count = 0;
    const auto dot = std::from_chars(from, to, process);
    if (dot.ec != std::errc() || dot.ptr == to || *dot.ptr != '.' || process <= 0) continue;
    const auto stop = std::from_chars(dot.ptr + 1, to, count);
    if (stop.ec != std::errc() || stop.ptr != to || is_alive(process)) continue;
    fs::remove(at->path(), ignored);
  }
}

}  // namespace

AtomicFile::AtomicFile(const fs::path& file) : file_(file) {
  static std::atomic<unsigned> counter{0};
  std::error_code error;
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  if (file.filename().empty() || fs::is_directory(file, error))
    user_error("{}: this is a folder; give the name of a file in it", file.string());
  if (!fs::is_directory(folder, error))
    user_error("{}: the folder {} does not exist; make it first", file.string(), folder.string());
  remove_left_behind(folder, file);
  temporary_ = folder / fmt::format("{}{}.{}{}", temporary_begin(file), ::getpid(), counter++, temporary_end(file));
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
