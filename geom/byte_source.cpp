#include "geom/byte_source.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <vector>

#include "geom/error.h"

namespace wale {

class ByteSource::File {
 public:
  explicit File(const std::filesystem::path& file) : number_(::open(file.c_str(), O_RDONLY | O_CLOEXEC)) {
    if (number_ < 0) user_error("{}: cannot be opened: {}", file.string(), std::strerror(errno));
  }
  ~File() { ::close(number_); }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  int number() const { return number_; }

 private:
  int number_;
};

ByteSource ByteSource::of_file(const std::filesystem::path& file) {
  ByteSource out;
  out.name_ = file.string();
  std::error_code failed;
  if (!std::filesystem::is_regular_file(file, failed)) user_error("{}: no such file", out.name_);
  out.size_ = std::filesystem::file_size(file, failed);
  if (failed) user_error("{}: cannot be read: {}", out.name_, failed.message());
  out.file_ = std::make_shared<File>(file);
  return out;
}

ByteSource ByteSource::of_memory(std::string_view bytes, const std::filesystem::path& name) {
  ByteSource out;
  out.name_ = name.string();
  out.size_ = bytes.size();
  out.memory_ = bytes;
  return out;
}

void ByteSource::read(uint64_t at, void* out, uint64_t bytes) const {
  const auto cut_off = [&] {
    user_error("{}: ends after {} bytes, where {} from byte {} on are needed; is the file cut off?", name_, size_,
               bytes, at);
  };
  if (at > size_ || bytes > size_ - at) cut_off();
  if (!file_) {
    if (bytes) std::memcpy(out, memory_.data() + at, bytes);
    return;
  }
  auto* to = static_cast<char*>(out);
  while (bytes > 0) {
    const ssize_t got = ::pread(file_->number(), to, bytes, off_t(at));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) user_error("{}: cannot be read: {}", name_, std::strerror(errno));
    if (got == 0) cut_off();
    to += got, at += uint64_t(got), bytes -= uint64_t(got);
  }
}

uint64_t hash_bytes(std::string_view bytes, uint64_t seed) {
  for (const char c : bytes) seed = (seed ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return seed;
}

uint64_t hash_bytes(const ByteSource& source, uint64_t at, uint64_t bytes, uint64_t seed) {
  std::vector<char> piece(std::min<uint64_t>(bytes, 1u << 20));
  while (bytes > 0) {
    const uint64_t n = std::min<uint64_t>(bytes, piece.size());
    source.read(at, piece.data(), n);
    seed = hash_bytes(std::string_view(piece.data(), n), seed);
    at += n, bytes -= n;
  }
  return seed;
}

}  // namespace wale
