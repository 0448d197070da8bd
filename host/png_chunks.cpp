#include "host/png_chunks.h"

#include <cstdint>

#include "geom/error.h"

namespace wale {

void require_whole_png_chunks(std::string_view bytes, const std::string& file) {
  constexpr size_t kFirstBytes = 8, kHead = 8, kCheck = 4;
  size_t at = kFirstBytes;
  while (at + kHead <= bytes.size()) {
    uint32_t length = 0;  // big endian
    for (size_t i = 0; i < 4; ++i) length = length << 8 | static_cast<unsigned char>(bytes[at + i]);
    const std::string_view type = bytes.substr(at + 4, 4);
    const size_t left = bytes.size() - at - kHead;
    if (length > left)
      user_error("{}: chunk \"{}\" has {} bytes, but the file has only {} more; is the file cut off?", file, type,
                 length, left);
    if (type == "IEND") return;
    at += kHead + length + kCheck;
  }
}

}  // namespace wale
