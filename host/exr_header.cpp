#include "host/exr_header.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <iterator>

#include "geom/error.h"
#include "host/exr_attributes.h"

namespace wale {
namespace {

constexpr size_t kPrologue = 8;  // first bytes, version and flags
constexpr uint32_t kMultipart = 0x1000;
constexpr int64_t kChunkBytes = 8;  // at least its place in the table of chunks
// One chunk is decoded at once, whatever part of it the image covers: 4096 x 4096 pixels of four channels.
constexpr int64_t kChunkValues = int64_t(1) << 26;
// Lines in a chunk by the number of the compression: none, RLE, ZIPS, ZIP, PIZ, PXR24, B44, B44A, DWAA, DWAB.
constexpr int64_t kChunkLines[] = {1, 1, 1, 16, 32, 16, 32, 32, 32, 256};

// Numbers are little endian; read byte by byte they are the same on every machine.
uint32_t unsigned_at(std::string_view bytes, size_t at) {
  uint32_t value = 0;
  for (size_t i = 0; i < 4; ++i) value |= uint32_t(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
  return value;
}

int64_t signed_at(std::string_view bytes, size_t at) { return static_cast<int32_t>(unsigned_at(bytes, at)); }

struct Part {
  int64_t width = 0, height = 0, channels = 0, chunk_lines = 1;
  int64_t tile_width = 0, tile_height = 0;  // 0: lines
  int64_t chunks = 0;                       // as the header says; 0: it does not
};

// Each is a name and 16 bytes.
int64_t count_channels(std::string_view list) {
  int64_t count = 0;
  while (!list.empty() && list[0] != '\0') {
    const size_t next = list.find('\0');
    if (next == std::string_view::npos) break;
    list.remove_prefix(std::min(list.size(), next + 17));
    ++count;
  }
  return count;
}

void take(Part& part, std::string_view name, std::string_view value) {
  if (name == "dataWindow" && value.size() == 16) {
    part.width = signed_at(value, 8) - signed_at(value, 0) + 1;
    part.height = signed_at(value, 12) - signed_at(value, 4) + 1;
  } else if (name == "channels") {
    part.channels = count_channels(value);
  } else if (name == "compression" && value.size() == 1) {
    const auto number = static_cast<unsigned char>(value[0]);
    part.chunk_lines = number < std::size(kChunkLines) ? kChunkLines[number] : 1;  // OpenEXR refuses the others
  } else if (name == "tiles" && value.size() == 9) {
    part.tile_width = unsigned_at(value, 0);
    part.tile_height = unsigned_at(value, 4);
  } else if (name == "chunkCount" && value.size() == 4) {
    part.chunks = signed_at(value, 0);
  }
}

// The attributes of one part, from `at` up to behind the zero that ends them.
Part read_part(std::string_view bytes, size_t& at, const std::string& file) {
  const auto word = [&] {
    const size_t end = bytes.find('\0', std::min(at, bytes.size()));
    if (end == std::string_view::npos) user_error("{}: ends within its header; is the file cut off?", file);
    const std::string_view text = bytes.substr(at, end - at);
    at = end + 1;
    return text;
  };
  Part part;
  for (std::string_view name = word(); !name.empty(); name = word()) {
    const std::string_view type = word();
    if (bytes.size() - at < 4) user_error("{}: ends within its header; is the file cut off?", file);
    const size_t size = unsigned_at(bytes, at);
    at += 4;
    if (size > bytes.size() - at)
      user_error("{}: attribute \"{}\" has {} bytes, but the file has only {} more; is the file cut off?", file,
                 name.substr(0, 64), size, bytes.size() - at);
    // OpenEXR reads values by their type: where that is another size, all that follows is taken for what it is not.
    const auto read = exr_value_size(type, bytes.substr(at), size);
    if (read && *read != size)
      user_error("{}: attribute \"{}\" of type {} says {} bytes and has {}; is the file damaged?", file,
                 name.substr(0, 64), type.substr(0, 32), size, *read);
    if (!read && type == "chlist") user_error("{}: ends within its list of channels; is the file cut off?", file);
    take(part, name, bytes.substr(at, size));
    at += size;
  }
  return part;
}

void require_plausible(const Part& part, size_t bytes, const std::string& file) {
  if (part.width <= 0 || part.height <= 0) return;
  const bool tiled = part.tile_width > 0 && part.tile_height > 0;
  const int64_t wide = tiled ? part.tile_width : part.width, high = tiled ? part.tile_height : part.chunk_lines;
  const int64_t across = (part.width - 1) / wide + 1, down = (part.height - 1) / high + 1;
  const int64_t places = int64_t(bytes) / kChunkBytes;
  if (across > places / down || part.chunks > places)
    user_error("{}: {} x {} pixels do not fit into its {} bytes; is the file cut off?", file, part.width, part.height,
               bytes);
  if (wide > kChunkValues / high / std::max<int64_t>(1, part.channels))
    user_error("{}: {} x {} pixels of {} channels in one piece are too many; write it in smaller tiles or lines", file,
               wide, high, part.channels);
}

}  // namespace

void require_plausible_exr(std::string_view bytes, const std::string& file) {
  if (bytes.size() < kPrologue) user_error("{}: ends within its header; is the file cut off?", file);
  const bool multipart = unsigned_at(bytes, 4) & kMultipart;
  size_t at = kPrologue;
  do {
    require_plausible(read_part(bytes, at, file), bytes.size(), file);
  } while (multipart && at < bytes.size() && bytes[at] != '\0');
}

std::optional<std::string> exr_text(std::string_view bytes, std::string_view name) {
  if (!bytes.starts_with("v/1\x01")) return {};
  for (size_t at = kPrologue; at < bytes.size();) {
    const size_t name_end = bytes.find('\0', at);
    if (name_end == at || name_end == std::string_view::npos) return {};
    const size_t type_end = bytes.find('\0', name_end + 1);
    if (type_end == std::string_view::npos || bytes.size() - type_end < 5) return {};
    const size_t size = unsigned_at(bytes, type_end + 1), value = type_end + 5;
    if (size > bytes.size() - value) return {};
    if (bytes.substr(at, name_end - at) == name && bytes.substr(name_end + 1, type_end - name_end - 1) == "string")
      return std::string(bytes.substr(value, size));
    at = value + size;
  }
  return {};
}

}  // namespace wale
