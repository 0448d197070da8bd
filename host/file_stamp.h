#pragma once
#include <cstdint>
#include <filesystem>

namespace wale {

/// Which file or folder a name leads to, when it was changed last, and how long it is.
struct FileStamp {
  std::filesystem::path file;
  std::filesystem::file_time_type changed{};
  uintmax_t bytes = 0, number = 0;
  bool settled = false;  ///< it was not young then: a later change has another time

  /// Whether or not they had settled.
  bool operator==(const FileStamp& other) const {
    return file == other.file && changed == other.changed && bytes == other.bytes && number == other.number;
  }
};

/// As it is now. One that is not there has a stamp too.
FileStamp stamp_of(const std::filesystem::path& file);

}  // namespace wale
