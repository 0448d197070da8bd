#pragma once
#include <filesystem>
#include <string>

namespace wale {

/// A file that appears whole or not at all: written under a temporary name in the same folder, renamed by commit().
/// When the object dies without commit(), nothing is left behind and an older file of that name is untouched. What a
/// program that was killed left of the same file is removed by the next run on that machine, as long as it has not been
/// started anew; for that a folder is looked through once a run.
class AtomicFile {
 public:
  /// Throws a user error when the folder does not exist or cannot be written, or `file` is a folder.
  explicit AtomicFile(const std::filesystem::path& file);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Where to write; it has the same suffix as the file.
  const std::filesystem::path& temporary() const { return temporary_; }
  /// Renames into place. Throws a user error when the disk refuses.
  void commit();
  /// The same, but false, and nothing done, where a file of that name has come up.
  bool commit_if_new();

 private:
  std::filesystem::path file_, temporary_;
  bool committed_ = false;
};

/// Writes a whole text (or any bytes) atomically. Throws a user error when it does not fit on the disk.
void write_text_file(const std::filesystem::path& file, const std::string& text);

/// The same, but false, and nothing written, where a file of that name exists.
bool write_new_text_file(const std::filesystem::path& file, const std::string& text);

/// Throws the user error that an AtomicFile of this name would throw, and leaves nothing behind.
void require_writable_path(const std::filesystem::path& file);

}  // namespace wale
