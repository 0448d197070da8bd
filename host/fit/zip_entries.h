#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace wale::fit {

/// A file in a ZIP archive, as its central directory tells (PKWARE, APPNOTE.TXT 6.3.10).
struct ZipEntry {
  std::string name;
  uint16_t method = 0;  ///< 0 stored, 8 deflate
  uint16_t flags = 0;
  uint32_t crc = 0, packed = 0, size = 0;  ///< sizes in bytes
  uint32_t header = 0;                     ///< place of its local header
};

/// Entries in the order of the directory. Throws user errors that begin with `file`: not an archive, cut off, in
/// several parts, larger than 4 GiB.
std::vector<ZipEntry> zip_entries(std::string_view bytes, const std::string& file);

/// The bytes of one entry, unpacked, CRC checked. Throws user errors "file: entry: ...": encrypted, packed in another
/// way, damaged. Reserves no more than its packed bytes can give.
std::string zip_content(std::string_view bytes, const ZipEntry& entry, const std::string& file);

}  // namespace wale::fit
