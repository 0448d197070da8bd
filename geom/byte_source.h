#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace wale {

/// Bytes read piece by piece: of a file, which may be larger than memory, or of memory.
class ByteSource {
 public:
  /// Throws a user error when the file cannot be opened.
  static ByteSource of_file(const std::filesystem::path& file);
  /// `bytes` must outlive the source; `name` is for messages.
  static ByteSource of_memory(std::string_view bytes, const std::filesystem::path& name);

  const std::string& name() const { return name_; }
  uint64_t size() const { return size_; }
  /// Throws a user error where the source ends before.
  void read(uint64_t at, void* out, uint64_t bytes) const;
  template <typename T>
  T read(uint64_t at) const {
    T value;
    read(at, &value, sizeof(T));
    return value;
  }

 private:
  class File;
  std::string name_;
  uint64_t size_ = 0;
  std::string_view memory_;
  std::shared_ptr<const File> file_;
};

/// FNV-1a, 64 bits (Fowler, Noll, Vo), of bytes behind those that gave `seed`.
constexpr uint64_t kHashSeed = 0xcbf29ce484222325u;
uint64_t hash_bytes(std::string_view bytes, uint64_t seed = kHashSeed);
/// The same of a piece of a source.
uint64_t hash_bytes(const ByteSource& source, uint64_t at, uint64_t bytes, uint64_t seed = kHashSeed);

}  // namespace wale
