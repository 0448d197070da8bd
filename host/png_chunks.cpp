#include "host/png_chunks.h"

#include <cstdint>

#include "geom/error.h"

namespace wale {
namespace {

constexpr size_t kFirstBytes = 8, kHead = 8, kCheck = 4;

uint32_t big_endian(std::string_view bytes, size_t at) {
  uint32_t value = 0;
  for (size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

void put(std::string& out, uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) out += char(value >> shift & 0xff);
}

// ISO/IEC 15948, annex D.
uint32_t crc(std::string_view bytes) {
  uint32_t c = ~0u;
  for (const char byte : bytes) {
    c ^= static_cast<unsigned char>(byte);
    for (int k = 0; k < 8; ++k) c = c & 1 ? 0xEDB88320u ^ c >> 1 : c >> 1;
  }
  return ~c;
}

}  // namespace

void add_png_text(std::string& png, const std::string& name, const std::string& text) {
  std::string chunk = "tEXt" + name + '\0' + text;
  std::string whole;
  put(whole, uint32_t(chunk.size() - 4));
  whole += chunk;
  put(whole, crc(chunk));
  png.insert(kFirstBytes + kHead + big_endian(png, kFirstBytes) + kCheck, whole);
}

std::optional<std::string> png_text(std::string_view bytes, std::string_view name) {
  for (size_t at = kFirstBytes; at + kHead <= bytes.size();) {
    const size_t length = big_endian(bytes, at);
    const std::string_view type = bytes.substr(at + 4, 4);
    if (type == "IDAT" || length > bytes.size() - at - kHead) return {};
    const std::string_view data = bytes.substr(at + kHead, length);
    if (type == "tEXt" && data.starts_with(name) && data.size() > name.size() && data[name.size()] == '\0')
      return std::string(data.substr(name.size() + 1));
    at += kHead + length + kCheck;
  }
  return {};
}

void require_whole_png_chunks(std::string_view bytes, const std::string& file) {
  size_t at = kFirstBytes;
  while (at + kHead <= bytes.size()) {
    const uint32_t length = big_endian(bytes, at);
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
