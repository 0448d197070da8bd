#include "host/atomic_file.h"

#include <unistd.h>

#include <atomic>
#include <fstream>

#include "geom/error.h"

namespace wale {
namespace fs = std::filesystem;

AtomicFile::AtomicFile(const fs::path& file) : file_(file) {
  // Process and counter: two programs, or two threads of one, may write the same name at once.
  static std::atomic<unsigned> counter{0};
  std::error_code error;
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  if (file.filename().empty() || fs::is_directory(file, error))
    user_error("{}: this is a folder; give the name of a file in it", file.string());
  if (!fs::is_directory(folder, error))
    user_error("{}: the folder {} does not exist; make it first", file.string(), folder.string());
  temporary_ =
      folder / fmt::format(".{}.{}.{}.tmp{}", file.stem().string(), ::getpid(), counter++, file.extension().string());
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
