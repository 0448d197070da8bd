#include "host/file_stamp.h"

#include <sys/stat.h>

#include <chrono>

namespace wale {

FileStamp stamp_of(const std::filesystem::path& file) {
  constexpr std::chrono::seconds kTick{2};  // of the coarsest clock of files
  std::error_code failed;                   // a file that has gone is stamped too
  FileStamp out{file};
  out.changed = std::filesystem::last_write_time(file, failed);
  out.settled = failed || std::filesystem::file_time_type::clock::now() - out.changed > kTick;
  if (std::filesystem::is_regular_file(file, failed)) out.bytes = std::filesystem::file_size(file, failed);
  if (struct stat status; ::stat(file.c_str(), &status) == 0) out.number = status.st_ino;
  return out;
}

}  // namespace wale
