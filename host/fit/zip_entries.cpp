#include "host/fit/zip_entries.h"

#include <zlib.h>

#include "geom/error.h"

namespace wale::fit {
namespace {

constexpr size_t kEndSize = 22, kEntrySize = 46, kLocalSize = 30, kMostComment = 65535;
constexpr std::string_view kEnd = "PK\5\6", kEntry = "PK\1\2", kLocal = "PK\3\4";
constexpr uint16_t kEncrypted = 1, kStored = 0, kDeflate = 8;
constexpr uint64_t kMostPerByte = 1032;  // deflate packs no more bytes into one

uint32_t number(std::string_view bytes, size_t at, size_t count) {
  uint32_t value = 0;
  for (size_t i = 0; i < count; ++i) value |= uint32_t(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
  return value;
}

// The end record is the last thing but for a comment.
size_t find_end(std::string_view bytes, const std::string& file) {
  if (bytes.size() >= kEndSize) {
    const size_t last = bytes.size() - kEndSize, first = last > kMostComment ? last - kMostComment : 0;
    for (size_t at = last + 1; at-- > first;)
      if (bytes.substr(at, 4) == kEnd) return at;
  }
  user_error("{}: its directory is missing; is it a .npz or .zip file, and whole?", file);
}

std::string inflated(std::string_view packed, uint32_t size, const std::string& where) {
  if (size > kMostPerByte * (uint64_t(packed.size()) + 1))
    user_error("{}: {} bytes cannot come from {} packed ones", where, size, packed.size());
  std::string out(size, '\0');
  z_stream stream{};
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.avail_in = uInt(packed.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = uInt(out.size());
  if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) bug("{}: zlib does not start", where);
  const int state = inflate(&stream, Z_FINISH);
  const bool whole = state == Z_STREAM_END && stream.total_out == size;
  inflateEnd(&stream);
  if (!whole) user_error("{}: cannot be unpacked; is the file damaged?", where);
  return out;
}

}  // namespace

std::vector<ZipEntry> zip_entries(std::string_view bytes, const std::string& file) {
  const size_t end = find_end(bytes, file);
  const uint32_t count = number(bytes, end + 10, 2), at = number(bytes, end + 16, 4);
  if (number(bytes, end + 4, 2) != 0 || number(bytes, end + 8, 2) != count)
    user_error("{}: is one part of an archive in several", file);
  if (at == 0xFFFFFFFF || count == 0xFFFF) user_error("{}: archives above 4 GiB or 65534 entries are not read", file);
  std::vector<ZipEntry> entries;
  uint64_t next = at;
  for (uint32_t i = 0; i < count; ++i) {
    if (next + kEntrySize > end || bytes.substr(next, 4) != kEntry)
      user_error("{}: entry {} of its directory is damaged", file, i + 1);
    const size_t p = size_t(next), name = number(bytes, p + 28, 2);
    if (next + kEntrySize + name > end) user_error("{}: entry {} of its directory is cut off", file, i + 1);
    entries.push_back({std::string(bytes.substr(p + kEntrySize, name)), uint16_t(number(bytes, p + 10, 2)),
                       uint16_t(number(bytes, p + 8, 2)), number(bytes, p + 16, 4), number(bytes, p + 20, 4),
                       number(bytes, p + 24, 4), number(bytes, p + 42, 4)});
    next += kEntrySize + name + number(bytes, p + 30, 2) + number(bytes, p + 32, 2);
  }
  return entries;
}

std::string zip_content(std::string_view bytes, const ZipEntry& entry, const std::string& file) {
  const std::string where = file + ": " + entry.name;
  if (entry.flags & kEncrypted) user_error("{}: is encrypted", where);
  const uint64_t header = entry.header;
  if (header + kLocalSize > bytes.size() || bytes.substr(header, 4) != kLocal)
    user_error("{}: has no header; is the file damaged?", where);
  // Its name and extra field; sizes may stand behind the data there, so the directory's hold.
  const uint64_t start = header + kLocalSize + number(bytes, header + 26, 2) + number(bytes, header + 28, 2);
  if (start + entry.packed > bytes.size()) user_error("{}: is cut off", where);
  const std::string_view packed = bytes.substr(start, entry.packed);
  std::string content;
  if (entry.method == kDeflate)
    content = inflated(packed, entry.size, where);
  else if (entry.method == kStored && entry.packed == entry.size)
    content = packed;
  else
    user_error("{}: packed by method {}; valid: stored (0) and deflate (8)", where, entry.method);
  if (crc32(0, reinterpret_cast<const Bytef*>(content.data()), uInt(content.size())) != entry.crc)
    user_error("{}: its check sum is wrong; is the file damaged?", where);
  return content;
}

}  // namespace wale::fit
