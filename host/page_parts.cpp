#include "host/page_parts.h"

#include <fmt/format.h>

#include <cstdint>

#include "geom/error.h"
#include "host/image_coder.h"

namespace wale {
namespace {

// RFC 4648.
std::string base64(const std::string& bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t word = 0;
    for (size_t k = 0; k < 3; ++k)
      word = word << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (size_t k = 0; k < 4; ++k) out += i + k > bytes.size() ? '=' : kDigits[word >> (18 - 6 * k) & 63];
  }
  return out;
}

}  // namespace

std::string html_text(const std::string& text) {
  std::string out;
  for (const char c : text) switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  return out;
}

std::string picture_tag(const std::vector<unsigned char>& rgb, int width, int height, int shown,
                        const std::string& what) {
  std::string png;
  if (const std::string failure = image_coder().encode_png(rgb, width, height, png); !failure.empty())
    bug("PNG: {}", one_line(failure));
  return fmt::format("<img width=\"{0}\" alt=\"{1}\" title=\"{1}\" src=\"data:image/png;base64,{2}\">", shown,
                     html_text(what), base64(png));
}

}  // namespace wale
