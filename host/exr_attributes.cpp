#include "host/exr_attributes.h"

#include <algorithm>
#include <cstdint>
#include <iterator>

namespace wale {
namespace {

struct FixedType {
  std::string_view name;
  size_t bytes;
};

constexpr FixedType kFixed[] = {
    {"box2f", 16}, {"box2i", 16}, {"chromaticities", 32}, {"compression", 1}, {"deepImageState", 1}, {"double", 8},
    {"envmap", 1}, {"float", 4},  {"int", 4},             {"keycode", 28},    {"lineOrder", 1},      {"m33d", 72},
    {"m33f", 36},  {"m44d", 128}, {"m44f", 64},           {"rational", 8},    {"tiledesc", 9},       {"timecode", 8},
    {"v2d", 16},   {"v2f", 8},    {"v2i", 8},             {"v3d", 24},        {"v3f", 12},           {"v3i", 12}};

uint64_t number_at(std::string_view bytes, size_t at) {
  uint64_t value = 0;
  for (size_t i = 0; i < 4; ++i) value |= uint64_t(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
  return value;
}

// Channels are a name and 16 bytes each; an empty name ends them.
std::optional<size_t> channel_list(std::string_view bytes) {
  for (size_t at = 0; at < bytes.size();) {
    const size_t end = bytes.find('\0', at);
    if (end == std::string_view::npos) return {};
    if (end == at) return at + 1;
    at = end + 17;
  }
  return {};
}

// Each text has its length before it.
std::optional<size_t> texts(std::string_view bytes, size_t declared) {
  size_t at = 0;
  while (at < declared) {
    if (at + 4 > bytes.size()) return {};
    at += 4 + number_at(bytes, at);
  }
  return at;
}

}  // namespace

std::optional<size_t> exr_value_size(std::string_view type, std::string_view bytes, size_t declared) {
  if (type == "stringvector") return texts(bytes, declared);
  if (type == "chlist") return channel_list(bytes);
  if (type == "preview" && bytes.size() >= 8) {
    const uint64_t width = number_at(bytes, 0), height = number_at(bytes, 4);
    return 8 + std::min<uint64_t>(width * height, bytes.size()) * 4;
  }
  const auto found = std::find_if(std::begin(kFixed), std::end(kFixed), [&](const auto& t) { return t.name == type; });
  if (found == std::end(kFixed)) return {};
  return found->bytes;
}

}  // namespace wale
