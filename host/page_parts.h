#pragma once
#include <string>
#include <vector>

namespace wale {

/// Text as it stands in an HTML page, between tags or in an attribute.
std::string html_text(const std::string& text);

/// An <img> that holds its picture as a PNG: 3 bytes a pixel, sRGB encoded, shown `shown` pixels wide; `what` says what
/// it shows.
std::string picture_tag(const std::vector<unsigned char>& rgb, int width, int height, int shown,
                        const std::string& what);

}  // namespace wale
